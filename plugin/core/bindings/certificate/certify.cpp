#include "bindings/bind.h"
#include "bindings/remesh/geometry_inputs.h"
#include "bindings/support/interrupt.h"
#include "certificate/circumspheres.h"
#include "certificate/delaunay_test.h"
#include "certificate/sharp_corners.h"
#include "certificate/surface/surface_stars.h"
#include "certificate/vertex_distortion.h"
#include "certificate/walled_mesh.h"
#include "plane/geometry/facet_bulges.h"
#include "surface/facet_bulges.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>

namespace anistar::bindings {
namespace {

bool look_on(double) {
  look_for_signals();
  return true;
}

/// A mesh, its walls and the metric at its points. Holds references to the arrays:
/// nothing is copied.
struct MetricMesh {
  Array2<double> points; ///< (n, d)
  Array2<Index> cells;   ///< (m, d + 1)
  Array2<Index> facets;  ///< (k, d), the walls
  Array3<double> metric; ///< (n, d, d)

  [[nodiscard]] std::size_t dimension() const { return points.shape(1); }
};

/// Calls ask(d, mesh) for the dimension of a mesh, with d as a constant.
template <class Ask> auto in_its_dimension(const MetricMesh &mesh, Ask ask) {
  const std::size_t d = mesh.dimension();
  if (d != 2 && d != 3)
    throw std::invalid_argument("points must have 2 or 3 columns, got " +
                                std::to_string(d));
  return d == 2 ? ask(std::integral_constant<std::size_t, 2>())
                : ask(std::integral_constant<std::size_t, 3>());
}

template <std::size_t d>
std::vector<Vertex<d>> vertices_of(const Array2<double> &points,
                                   const Array3<double> &metric) {
  const auto x = points_of<d>(points);
  const auto tensors = tensors_of<d>(metric);
  if (tensors.size() != x.size())
    throw std::invalid_argument("points and metric differ in length");
  std::vector<Vertex<d>> vertices;
  vertices.reserve(x.size());
  for (std::size_t v = 0; v < x.size(); ++v)
    vertices.push_back(make_vertex<d>(x[v], tensors[v]));
  return vertices;
}

/// The vertices of a mesh and its cells, as the core takes them.
template <std::size_t d> struct Cells {
  std::vector<Vertex<d>> vertices;
  std::span<const Cell<d>> cells;

  explicit Cells(const MetricMesh &mesh)
      : vertices(vertices_of<d>(mesh.points, mesh.metric)),
        cells(cells_of<d>(mesh.cells)) {}
};

/// The same with the walls.
template <std::size_t d> struct CellsAndWalls : Cells<d> {
  WalledMesh<d> walled;

  explicit CellsAndWalls(const MetricMesh &mesh)
      : Cells<d>(mesh), walled(this->vertices, this->cells, facets_of<d>(mesh.facets)) {
  }
};

using Bytes = nb::ndarray<nb::numpy, std::uint8_t>;
using Doubles = nb::ndarray<nb::numpy, double>;
using Count = std::pair<std::size_t, std::size_t>; ///< how many, of how many

template <class T> nb::ndarray<nb::numpy, T> row(std::vector<T> &&values) {
  const std::size_t n = values.size();
  return owned(std::move(values), {n});
}

std::span<const std::uint8_t> bytes_of(const Array1<std::uint8_t> &array) {
  return {array.data(), array.shape(0)};
}

Bytes delaunay(const MetricMesh &mesh, int threads) {
  return row(in_its_dimension(mesh, [&](auto d) {
    nb::gil_scoped_release release;
    const CellsAndWalls<d> given(mesh);
    return delaunay_bits<d>(given.walled.view(), threads, look_on).bits;
  }));
}

std::optional<Bytes> delaunay_across_interfaces(const MetricMesh &mesh, int threads) {
  auto bits = in_its_dimension(mesh, [&](auto d) {
    nb::gil_scoped_release release;
    if (!has_interfaces<d>(cells_of<d>(mesh.cells), facets_of<d>(mesh.facets),
                           mesh.points.shape(0)))
      return std::optional<std::vector<std::uint8_t>>();
    CellsAndWalls<d> given(mesh);
    given.walled.open_interfaces();
    return std::optional(delaunay_bits<d>(given.walled.view(), threads, look_on).bits);
  });
  return bits ? std::optional(row(std::move(*bits))) : std::nullopt;
}

Bytes exempt(const MetricMesh &mesh, const Array1<std::uint8_t> &star_ok) {
  return row(in_its_dimension(mesh, [&](auto d) {
    nb::gil_scoped_release release;
    const CellsAndWalls<d> given(mesh);
    return exempt_vertices<d>(given.walled.view(), bytes_of(star_ok));
  }));
}

Doubles distortion_at_vertices(const MetricMesh &mesh, int threads) {
  return row(in_its_dimension(mesh, [&](auto d) {
    nb::gil_scoped_release release;
    const Cells<d> given(mesh);
    return vertex_distortion<d>(given.vertices, given.cells, threads, look_on);
  }));
}

nb::typed<nb::tuple, Doubles, Doubles, Count, Count>
circumspheres(const MetricMesh &mesh, const Array1<std::uint8_t> &bits, int threads) {
  auto [shapes, restricted] = in_its_dimension(mesh, [&](auto d) {
    nb::gil_scoped_release release;
    const CellsAndWalls<d> given(mesh);
    return circumsphere_figures<d>(given.walled.view(), bytes_of(bits), threads,
                                   look_on);
  });
  return nb::make_tuple(row(std::move(shapes.radius_edge)),
                        row(std::move(shapes.sliverity)),
                        Count(restricted.v1.ok, restricted.v1.of),
                        Count(restricted.v2.ok, restricted.v2.of));
}

Index violator(const MetricMesh &mesh, Index cell, const Array2<double> &metric) {
  if (cell < 0 || std::cmp_greater_equal(cell, mesh.cells.shape(0)))
    throw std::invalid_argument("cell " + std::to_string(cell) + " is out of range");
  return in_its_dimension(mesh, [&](auto d) {
    const CellsAndWalls<d> given(mesh);
    return DelaunayTest<d>(given.walled.view()).violator(cell, tensor_of<d>(metric));
  });
}

/// The heights of facet_bulge.h, (k, 1) or (k, 3).
template <std::size_t d> constexpr std::size_t n_heights = FacetBulge<d>().size();

Doubles facet_bulges_of(const MeshArrays &mesh, const DomainShape &shape) {
  const auto found = [&](auto bulges) {
    constexpr std::size_t n = std::tuple_size_v<typename decltype(bulges)::value_type>;
    const std::size_t k = bulges.size();
    std::vector<double> heights;
    heights.reserve(n * k);
    for (const auto &bulge : bulges)
      heights.insert(heights.end(), bulge.begin(), bulge.end());
    return owned(std::move(heights), {k, n});
  };
  if (mesh.dimension() == 2)
    return found([&] {
      nb::gil_scoped_release release;
      return facet_bulges(curves_of(mesh, shape));
    }());
  return found([&] {
    nb::gil_scoped_release release;
    return facet_bulges(surfaces_of(mesh, shape));
  }());
}

template <std::size_t d>
SurfaceFacets<d> surface_of(const MetricMesh &mesh, const Array2<double> &bulges) {
  if (bulges.shape(0) != mesh.facets.shape(0) || bulges.shape(1) != n_heights<d>)
    throw std::invalid_argument("bulges have the wrong shape");
  const auto *first = reinterpret_cast<const FacetBulge<d> *>(bulges.data());
  return {facets_of<d>(mesh.facets), {first, bulges.shape(0)}};
}

Bytes surface_delaunay(const MetricMesh &mesh, const Array2<double> &bulges,
                       int threads) {
  return row(in_its_dimension(mesh, [&](auto d) {
    nb::gil_scoped_release release;
    const CellsAndWalls<d> given(mesh);
    return surface_bits<d>(given.walled.view(), surface_of<d>(mesh, bulges), threads,
                           look_on);
  }));
}

/// A vertex inside the surface ball of a facet, or -1; the shift of the ball.
std::pair<Index, double> surface_violator(const MetricMesh &mesh,
                                          const Array2<double> &bulges, Index facet,
                                          std::size_t corner) {
  if (facet < 0 || std::cmp_greater_equal(facet, mesh.facets.shape(0)) ||
      corner >= mesh.dimension())
    throw std::invalid_argument("there is no such corner of a facet");
  return in_its_dimension(mesh, [&](auto d) {
    const CellsAndWalls<d> given(mesh);
    const CertifiedMesh<d> walled = given.walled.view();
    for (const SeenFacet<d> &found :
         seen_facets<d>(walled, surface_of<d>(mesh, bulges)))
      if (walled.constraints[found.at.cell()][found.at.facet()] == facet) {
        const SymmetricTensor<d> &M = walled.vertices[found.vertices[corner]].M;
        const double shift = found.seen[corner].shift;
        if (!std::isfinite(shift)) // there is no ball
          return std::pair(none, shift);
        return std::pair(
            DelaunayTest<d>(walled).violator(found.at, M, found.seen[corner]), shift);
      }
    throw std::invalid_argument("facet " + std::to_string(facet) + " is of no cell");
  });
}

void construct(MetricMesh *self, const Array2<double> &points,
               const Array2<Index> &cells, const Array2<Index> &facets,
               const Array3<double> &metric) {
  new (self) MetricMesh{points, cells, facets, metric};
}

} // namespace

void bind_certify(nb::module_ &module) {
  nb::class_<MetricMesh>(
      module, "MetricMesh",
      "A mesh with its walls and the metric at its points, which are "
      "not copied: what a certificate says of it.")
      .def("__init__", &construct, nb::kw_only(), nb::arg("points").noconvert(),
           nb::arg("cells").noconvert(), nb::arg("facets").noconvert(),
           nb::arg("metric").noconvert())
      .def("delaunay", &delaunay, nb::kw_only(), nb::arg("threads"),
           "Per cell, bit k: it is Delaunay in the metric of its vertex k.")
      .def("delaunay_across_interfaces", &delaunay_across_interfaces, nb::kw_only(),
           nb::arg("threads"),
           "The same where interfaces are no walls; None where there is no interface.")
      .def("exempt", &exempt, nb::kw_only(), nb::arg("star_ok").noconvert(),
           "Per vertex, whether its star fails and may, at a sharp corner.")
      .def("distortion", &distortion_at_vertices, nb::kw_only(), nb::arg("threads"),
           "Per vertex, the largest distortion along its edges.")
      .def("circumspheres", &circumspheres, nb::kw_only(),
           nb::arg("delaunay").noconvert(), nb::arg("threads"),
           "Per cell the radius-edge ratio and the sliverity; and for both versions of "
           "the paper (how many, of how many) cells are in the restricted stars of all "
           "their vertices.")
      .def("violator", &violator, nb::kw_only(), nb::arg("cell"),
           nb::arg("metric").noconvert(),
           "A vertex that the cell reaches inside its circumsphere for one metric, "
           "-1 when it is Delaunay.")
      .def("surface_delaunay", &surface_delaunay, nb::kw_only(),
           nb::arg("bulges").noconvert(), nb::arg("threads"),
           "Per facet, bit k: it is in the surface star of its vertex k.")
      .def("surface_violator", &surface_violator, nb::kw_only(),
           nb::arg("bulges").noconvert(), nb::arg("facet"), nb::arg("corner"),
           "A vertex that a facet reaches inside its surface ball for the metric of a "
           "corner, -1 when there is none, and the shift of that ball.");
  module.def("facet_bulges", &facet_bulges_of, nb::arg("mesh"), nb::arg("shape"),
             "Heights of the smooth shape over the middles of the edges opposite the "
             "vertices of every facet, (k, 3); in 2D over its middle, (k, 1).");
}

} // namespace anistar::bindings
