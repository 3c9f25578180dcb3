#include "bindings/bind.h"
#include "bindings/support/geometry.h"
#include "generate/facets/equal_points.h"
#include "generate/facets/planar_facets.h"
#include "generate/facets/surface_loops.h"
#include "generate/facets/triangulated_facets.h"

namespace anistar::bindings {
namespace {

using namespace anistar::generate;
using Array1Long = Array1<std::int64_t>;

/// Indices are looked at before, in Python, where the culprit has a name.
nb::tuple triangulated(const Array2<double> &points, const Array1<Index> &indices,
                       const Array1Long &loop_starts, const Array1Long &facet_starts,
                       const Array2<Index> &edges, double flatness) {
  const FacetLoops loops{indices_of(indices),
                         {loop_starts.data(), loop_starts.shape(0)},
                         {facet_starts.data(), facet_starts.shape(0)}};
  TriangulatedFacets facets;
  {
    nb::gil_scoped_release release;
    facets =
        triangulated_facets(points_of<3>(points), loops, pairs_of(edges), flatness);
  }
  const std::size_t n = facets.triangles.size(), n_facets = facets.deviations.size();
  return nb::make_tuple(rows<Index, 3>(std::move(facets.triangles)),
                        owned(std::move(facets.triangle_facets), {n}),
                        owned(std::move(facets.deviations), {n_facets}));
}

auto planar(const Array2<double> &points, const Array2<Index> &triangles,
            const Array1<Index> &tags, double degrees, double distance,
            double rounding) {
  const double sine = elementary::sine_cosine(degrees * (std::numbers::pi / 180)).sine;
  std::vector<Index> facets;
  {
    nb::gil_scoped_release release;
    facets = planar_facets(points_of<3>(points), facets_of<3>(triangles),
                           indices_of(tags), {sine, distance, rounding});
  }
  const std::size_t n = facets.size();
  return owned(std::move(facets), {n});
}

nb::tuple loops_of(const Array2<double> &points, const Array2<Index> &triangles,
                   const Array1<Index> &owners, std::size_t n_facets) {
  SurfaceLoops loops;
  {
    nb::gil_scoped_release release;
    loops = surface_loops(points_of<3>(points), facets_of<3>(triangles),
                          indices_of(owners), n_facets);
  }
  const std::size_t n_indices = loops.indices.size(),
                    n_loops = loops.loop_starts.size();
  return nb::make_tuple(owned(std::move(loops.indices), {n_indices}),
                        owned(std::move(loops.loop_starts), {n_loops}),
                        owned(std::move(loops.facet_starts), {n_facets + 1}));
}

auto equal_points(const Array2<double> &points) {
  std::vector<Index> first;
  {
    nb::gil_scoped_release release;
    first = first_at_place(points_of<3>(points));
  }
  const std::size_t n = first.size();
  return owned(std::move(first), {n});
}

} // namespace

void bind_facets(nb::module_ &module) {
  module.def("first_at_place", &equal_points, nb::arg("points").noconvert(),
             "Of each point the first one that is exactly where it is.");
  module.def(
      "triangulated_facets", &triangulated, nb::arg("points").noconvert(),
      nb::arg("indices").noconvert(), nb::arg("loop_starts").noconvert(),
      nb::arg("facet_starts").noconvert(), nb::arg("edges").noconvert(),
      nb::arg("flatness"),
      "The triangles of polygon facets, the facet of each, and how far the points "
      "of each facet lie from its plane.");
  module.def("planar_facets", &planar, nb::arg("points").noconvert(),
             nb::arg("triangles").noconvert(), nb::arg("tags").noconvert(),
             nb::arg("degrees"), nb::arg("distance"), nb::arg("rounding"),
             "The planar facet of each triangle of a surface.");
  module.def("surface_loops", &loops_of, nb::arg("points").noconvert(),
             nb::arg("triangles").noconvert(), nb::arg("owners").noconvert(),
             nb::arg("n_facets"),
             "The loops around facets of triangles: (indices, loop_starts, "
             "facet_starts).");
}

} // namespace anistar::bindings
