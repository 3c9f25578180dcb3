#include "certificate/certify.h"
#include "bindings/bind.h"
#include "bindings/support/geometry.h"
#include "bindings/support/interrupt.h"
#include "certificate/delaunay_test.h"

namespace anistar::bindings {
namespace {

template <std::size_t d>
nb::dict certify_mesh(const Array2<double> &points, const Array2<Index> &cells,
                      const Array3<double> &metric, const Array2<Index> &facets,
                      int threads) {
  const auto x = points_of<d>(points);
  const auto simplices = cells_of<d>(cells);
  const auto constrained = facets_of<d>(facets);
  const auto tensors = tensors_of<d>(metric);
  if (tensors.size() != x.size())
    throw std::invalid_argument("points and metric differ in length");
  CertificateResult out;
  {
    nb::gil_scoped_release release;
    std::vector<Vertex<d>> vertices;
    vertices.reserve(x.size());
    for (std::size_t v = 0; v < x.size(); ++v)
      vertices.push_back(make_vertex<d>(x[v], tensors[v]));
    out = certify<d>(vertices, simplices, constrained, threads, &look_for_signals);
  }
  const std::size_t n = x.size(), m = simplices.size();
  nb::dict result;
  result["delaunay"] = owned(std::move(out.delaunay), {m});
  result["simplex_ok"] = owned(std::move(out.simplex_ok), {m});
  result["star_ok"] = owned(std::move(out.star_ok), {n});
  result["distortion"] = owned(std::move(out.distortion), {n});
  result["radius_edge"] = owned(std::move(out.radius_edge), {m});
  result["sliverity"] = owned(std::move(out.sliverity), {m});
  result["exempt"] = owned(std::move(out.exempt), {n});
  result["stars_without_interfaces"] = out.stars_without_interfaces;
  result["restricted_v1"] = nb::make_tuple(out.restricted_v1_ok, out.restricted_v1);
  result["restricted_v2"] = nb::make_tuple(out.restricted_v2_ok, out.restricted_v2);
  return result;
}

template <std::size_t d>
Index violator(const Array2<double> &points, const Array2<Index> &cells,
               const Array2<Index> &facets, Index cell, const Array2<double> &metric) {
  const auto x = points_of<d>(points);
  const auto simplices = cells_of<d>(cells);
  if (cell < 0 || std::cmp_greater_equal(cell, simplices.size()))
    throw std::invalid_argument("cell " + std::to_string(cell) + " is out of range");
  const SymmetricTensor<d> M = tensor_of<d>(metric);
  std::vector<Vertex<d>> vertices;
  for (const Vector<d> &p : x)
    vertices.push_back(make_vertex<d>(p, M));
  const auto neighbours = adjacency<d>(simplices, x.size());
  const auto constraints = walls<d>(simplices, facets_of<d>(facets), x.size());
  return DelaunayTest<d>({vertices, simplices, neighbours, constraints})
      .violator(cell, M);
}

template <std::size_t d> void bind_dimension(nb::module_ &module) {
  const std::string suffix = std::to_string(d);
  module.def(("certify" + suffix).c_str(), &certify_mesh<d>,
             nb::arg("points").noconvert(), nb::arg("cells").noconvert(),
             nb::arg("metric").noconvert(), nb::arg("facets").noconvert(),
             nb::arg("threads"),
             "The certificate of a mesh for the metric at its points.");
  module.def(("delaunay_violator" + suffix).c_str(), &violator<d>,
             nb::arg("points").noconvert(), nb::arg("cells").noconvert(),
             nb::arg("facets").noconvert(), nb::arg("cell"),
             nb::arg("metric").noconvert(),
             "A vertex that the cell reaches inside its circumsphere for one metric, "
             "-1 when it is Delaunay.");
}

} // namespace

void bind_certify(nb::module_ &module) {
  bind_dimension<2>(module);
  bind_dimension<3>(module);
}

} // namespace anistar::bindings
