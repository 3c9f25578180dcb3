#include "bindings/for_tests/bind.h"
#include "bindings/support/geometry.h"
#include "certificate/walled_mesh.h"

namespace anistar::bindings {
namespace {

/// A mesh for the certificate, with what it refers to.
template <std::size_t d> struct OwnMesh {
  std::vector<Vertex<d>> vertices;
  std::vector<Cell<d>> cells;
  std::vector<Neighbours<d>> neighbours;
  std::vector<std::array<Index, d + 1>> constraints;

  OwnMesh(const Array2<double> &points, const Array2<Index> &of,
          const Array3<double> &metric, const Array2<Index> &facets) {
    const auto simplices = cells_of<d>(of);
    cells.assign(simplices.begin(), simplices.end());
    const auto x = points_of<d>(points);
    const auto M = tensors_of<d>(metric);
    if (M.size() != x.size())
      throw std::invalid_argument("points and metric differ in length");
    for (std::size_t v = 0; v < x.size(); ++v)
      vertices.push_back(make_vertex<d>(x[v], M[v]));
    neighbours = adjacency<d>(cells, x.size());
    constraints = walls<d>(cells, facets_of<d>(facets), x.size());
  }
  [[nodiscard]] CertifiedMesh<d> view() const {
    return {vertices, cells, neighbours, constraints};
  }
};

template <std::size_t d>
auto renewed(const Array2<double> &points, const Array2<Index> &cells,
             const Array3<double> &metric, const Array2<Index> &facets,
             const Array2<double> &new_points, const Array2<Index> &new_cells,
             int threads) {
  const OwnMesh<d> before(points, cells, metric, facets);
  const OwnMesh<d> after(new_points, new_cells, metric, facets);
  std::vector<Index> changed;
  for (std::size_t c = 0; c < after.cells.size(); ++c) {
    bool has_changed = c >= before.cells.size() || before.cells[c] != after.cells[c];
    for (const Index v : after.cells[c])
      has_changed = has_changed || before.vertices[v].x != after.vertices[v].x;
    if (has_changed)
      changed.push_back(static_cast<Index>(c));
  }
  const Look to_the_end = [](double) { return true; };
  DelaunayBits known = delaunay_bits<d>(before.view(), threads, to_the_end);
  renew_bits<d>(after.view(), changed, threads, to_the_end, known);
  const std::size_t m = after.cells.size();
  return owned(std::move(known.bits), {m});
}

template <std::size_t d> void bind_dimension(nb::module_ &module) {
  module.def(
      ("renewed_bits" + std::to_string(d)).c_str(), &renewed<d>,
      nb::arg("points").noconvert(), nb::arg("cells").noconvert(),
      nb::arg("metric").noconvert(), nb::arg("facets").noconvert(),
      nb::arg("new_points").noconvert(), nb::arg("new_cells").noconvert(),
      nb::arg("threads"),
      "The certificate's bits after a change: found before it, and renewed where "
      "they depend on cells that are not as they were.");
}

} // namespace

void bind_renewed_bits(nb::module_ &module) {
  bind_dimension<2>(module);
  bind_dimension<3>(module);
}

} // namespace anistar::bindings
