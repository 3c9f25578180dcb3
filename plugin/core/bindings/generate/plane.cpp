#include "bindings/bind.h"
#include "bindings/support/interrupt.h"
#include "bindings/support/mesh_arrays.h"
#include "generate/plane/constrained.h"
#include "generate/plane/parts.h"
#include "generate/plane/refinement.h"
#include "generate/plane/walls.h"

#include "base/errors.h"

#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <map>
#include <tuple>

namespace anistar::bindings {
namespace {

using namespace anistar::generate;

Array1<Index> column_of(std::vector<Index> &&values) {
  const std::size_t n = values.size();
  return held<Array1<Index>>(owned(std::move(values), {n}));
}

/// With the walls as facets, whose tags are their segments.
MeshArrays arrays_of(PlaneMesh &&mesh) {
  WallList walls = walls_of(mesh);
  return {
      .points = held<Array2<double>>(rows<double, 2>(std::move(mesh.points))),
      .cells = held<Array2<Index>>(rows<Index, 3>(std::move(mesh.cells))),
      .cell_tags = column_of(std::move(mesh.regions)),
      .facets = held<Array2<Index>>(rows<Index, 2>(std::move(walls.edges))),
      .facet_tags = column_of(std::move(walls.segments)),
      .edges = held<Array2<Index>>(rows<Index, 2>(std::vector<Segment>())),
      .edge_tags = column_of({}),
      .corners = column_of({}),
  };
}

MeshArrays constrained(const Array2<double> &points, const Array2<Index> &segments,
                       const Array1<Index> &turns, const Array1<Index> &points_kept,
                       const Array2<double> &seeds, const Array1<Index> &seed_tags,
                       const Array2<double> &holes, Inside inside, double max_seconds,
                       nb::handle callback) {
  const PlanarComplex complex{points_of<2>(points), pairs_of(segments),
                              indices_of(turns),    indices_of(points_kept),
                              points_of<2>(seeds),  indices_of(seed_tags),
                              points_of<2>(holes),  inside};
  constexpr std::size_t no_bound = std::numeric_limits<std::size_t>::max();
  Monitor monitor(progress_of(callback), no_bound, max_seconds);
  PlaneMesh mesh;
  try {
    nb::gil_scoped_release release;
    monitor.enter("triangulate");
    mesh = inside_of(constrained_hull(complex, monitor), complex, monitor);
  } catch (const BudgetSpent &) {
    throw MeshingError("the time was up before the points and segments were in a mesh",
                       complex.points.front());
  }
  return arrays_of(std::move(mesh));
}

using Counts = std::map<std::string, std::size_t>;

std::tuple<MeshArrays, Counts, StopReason>
refined(const MeshArrays &mesh, const Array2<double> &given_points,
        const Array2<Index> &segments, double bound, const Array1<double> &sizes,
        const Array1<Index> &region_tags, const Array1<double> &region_sizes,
        std::size_t max_vertices, double max_seconds, nb::handle callback) {
  if (sizes.shape(0) != mesh.points.shape(0))
    throw std::invalid_argument("sizes must have a number for every point");
  Monitor monitor(progress_of(callback), max_vertices, max_seconds);
  PlaneMesh fine = walled_mesh(points_of<2>(mesh.points), cells_of<2>(mesh.cells),
                               indices_of(mesh.cell_tags), pairs_of(mesh.facets),
                               indices_of(mesh.facet_tags));
  PlaneRefinementCounts done;
  {
    nb::gil_scoped_release release;
    monitor.enter("refine");
    const InputAngles angles(points_of<2>(given_points), pairs_of(segments));
    PlaneCriteria criteria{
        .bound = bound,
        .sizes = {sizes.data(), sizes.data() + sizes.shape(0)},
        .region_tags = indices_of(region_tags),
        .region_sizes = {region_sizes.data(), region_sizes.shape(0)},
    };
    done = refine(fine, angles, std::move(criteria), monitor);
  }
  const Counts counts{{"split_segments", done.split_segments},
                      {"off_centres", done.off_centres},
                      {"rejected", done.rejected},
                      {"at_small_angles", done.at_small_angles},
                      {"refused", done.refused}};
  return {arrays_of(std::move(fine)), counts, monitor.reason()};
}

} // namespace

void bind_plane(nb::module_ &module) {
  nb::enum_<Inside>(module, "Inside")
      .value("parity", Inside::parity)
      .value("winding", Inside::winding)
      .value("nonzero", Inside::nonzero);
  module.def("constrained_triangles", &constrained, nb::kw_only(),
             nb::arg("points").noconvert(), nb::arg("segments").noconvert(),
             nb::arg("turns").noconvert(), nb::arg("points_kept").noconvert(),
             nb::arg("seeds").noconvert(), nb::arg("seed_tags").noconvert(),
             nb::arg("holes").noconvert(), nb::arg("inside"), nb::arg("max_seconds"),
             nb::arg("callback").none(),
             "The constrained Delaunay mesh of what segments enclose. All points are "
             "there; the tags of facets are their segments.");
  module.def("refined_triangles", &refined, nb::arg("mesh"), nb::kw_only(),
             nb::arg("given_points").noconvert(), nb::arg("segments").noconvert(),
             nb::arg("bound"), nb::arg("sizes").noconvert(),
             nb::arg("region_tags").noconvert(), nb::arg("region_sizes").noconvert(),
             nb::arg("max_vertices"), nb::arg("max_seconds"),
             nb::arg("callback").none(),
             "A constrained mesh after Delaunay refinement, what was counted, and what "
             "ended it.");
}

} // namespace anistar::bindings
