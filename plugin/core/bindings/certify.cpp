#include "../certify.h"
#include "bind.h"
#include "geometry.h"

namespace anistar::bindings {
namespace {

nb::dict certify2(const Array2<double> &points, const Array2<Index> &cells,
                  const Array3<double> &metric, const Array2<Index> &facets,
                  int threads) {
  const auto x = points_of<2>(points);
  const auto simplices = cells_of<2>(cells);
  const auto constrained = facets_of<2>(facets);
  const auto tensors = tensors_of<2>(metric);
  if (tensors.size() != x.size())
    throw std::invalid_argument("points and metric differ in length");
  CertificateResult out;
  {
    nb::gil_scoped_release release;
    std::vector<Vertex<2>> vertices;
    vertices.reserve(x.size());
    for (std::size_t v = 0; v < x.size(); ++v)
      vertices.push_back(make_vertex<2>(x[v], tensors[v]));
    out = certify(vertices, simplices, constrained, threads);
  }
  const std::size_t n = x.size(), m = simplices.size();
  nb::dict result;
  result["delaunay"] = owned(std::move(out.delaunay), {m});
  result["simplex_ok"] = owned(std::move(out.simplex_ok), {m});
  result["star_ok"] = owned(std::move(out.star_ok), {n});
  result["distortion"] = owned(std::move(out.distortion), {n});
  result["radius_edge"] = owned(std::move(out.radius_edge), {m});
  result["exempt"] = owned(std::move(out.exempt), {n});
  result["stars_without_interfaces"] = out.stars_without_interfaces;
  result["restricted_v1"] = nb::make_tuple(out.restricted_v1_ok, out.restricted_v1);
  result["restricted_v2"] = nb::make_tuple(out.restricted_v2_ok, out.restricted_v2);
  return result;
}

Index delaunay_violator2(const Array2<double> &points, const Array2<Index> &cells,
                         const Array2<Index> &facets, Index cell,
                         const Array2<double> &metric) {
  const auto x = points_of<2>(points);
  const auto simplices = cells_of<2>(cells);
  if (cell < 0 || static_cast<std::size_t>(cell) >= simplices.size())
    throw std::invalid_argument("cell " + std::to_string(cell) + " is out of range");
  SymmetricTensor<2> M;
  M.entries = {metric(0, 0), metric(1, 0), metric(1, 1)};
  std::vector<Vertex<2>> vertices;
  for (const Vector<2> &p : x)
    vertices.push_back(make_vertex<2>(p, M));
  const auto neighbours = adjacency<2>(simplices, x.size());
  const auto constraints = walls(simplices, facets_of<2>(facets), x.size());
  return DelaunayTest({vertices, simplices, neighbours, constraints}).violator(cell, M);
}

int in_metric_circle(const Array2<double> &metric, const Array2<double> &triangle,
                     const Array1<double> &point) {
  SymmetricTensor<2> M;
  M.entries = {metric(0, 0), metric(1, 0), metric(1, 1)};
  const auto x = points_of<2>(triangle);
  return static_cast<int>(
      in_metric_sphere(M, x[0], x[1], x[2], Vector<2>(point(0), point(1))));
}

} // namespace

void bind_certify(nb::module_ &module) {
  module.def("certify2", &certify2, nb::arg("points").noconvert(),
             nb::arg("cells").noconvert(), nb::arg("metric").noconvert(),
             nb::arg("facets").noconvert(), nb::arg("threads"),
             "The certificate of a 2D mesh for the metric at its points.");
  module.def("delaunay_violator2", &delaunay_violator2, nb::arg("points").noconvert(),
             nb::arg("cells").noconvert(), nb::arg("facets").noconvert(),
             nb::arg("cell"), nb::arg("metric").noconvert(),
             "A vertex that the cell reaches inside its circumcircle for one metric, "
             "-1 when it is Delaunay.");
  module.def("in_metric_circle", &in_metric_circle, nb::arg("metric").noconvert(),
             nb::arg("triangle").noconvert(), nb::arg("point").noconvert(),
             "Exactly: 1 inside, 0 on, -1 outside the circumscribed ellipse.");
}

} // namespace anistar::bindings
