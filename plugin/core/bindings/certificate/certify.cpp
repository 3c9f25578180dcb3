#include "certificate/certify.h"
#include "bindings/bind.h"
#include "bindings/support/geometry.h"
#include "certificate/facet_test.h"

namespace anistar::bindings {
namespace {

template <std::size_t d> SymmetricTensor<d> tensor_of(const Array2<double> &metric) {
  if (metric.shape(0) != d || metric.shape(1) != d)
    throw std::invalid_argument("metric is not of shape (" + std::to_string(d) + ", " +
                                std::to_string(d) + ")");
  SymmetricTensor<d> M;
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      M(i, j) = metric(i, j);
  return M;
}

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
    out = certify<d>(vertices, simplices, constrained, threads, [] {
      nb::gil_scoped_acquire acquire;
      if (PyErr_CheckSignals() != 0)
        throw nb::python_error();
    });
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

template <std::size_t d> Simplex<d> simplex_of(const Array2<double> &array) {
  const auto x = points_of<d>(array);
  if (x.size() != d + 1)
    throw std::invalid_argument("a simplex has " + std::to_string(d + 1) +
                                " vertices, not " + std::to_string(x.size()));
  Simplex<d> s;
  std::copy(x.begin(), x.end(), s.begin());
  return s;
}

template <std::size_t d> Vector<d> point_of(const Array1<double> &array) {
  if (array.shape(0) != d)
    throw std::invalid_argument("a point has " + std::to_string(d) +
                                " coordinates, not " + std::to_string(array.shape(0)));
  return Eigen::Map<const Vector<d>>(array.data());
}

template <std::size_t d>
int in_sphere(const Array2<double> &metric, const Array2<double> &simplex,
              const Array1<double> &point) {
  return static_cast<int>(in_metric_sphere<d>(
      tensor_of<d>(metric), simplex_of<d>(simplex), point_of<d>(point)));
}

template <std::size_t d>
int side_of_ball(const Array2<double> &metric, const Array2<double> &simplex,
                 const Array1<double> &point) {
  const SymmetricTensor<d> M = tensor_of<d>(metric);
  const Simplex<d> s = simplex_of<d>(simplex);
  const Vector<d> p = point_of<d>(point);
  const Circumball<d> ball(M, s);
  return static_cast<int>(ball.side(p, ball.power(p)));
}

template <std::size_t d>
bool meets_ball(const Array2<double> &metric, const Array2<double> &simplex,
                const Array2<double> &facet) {
  const auto y = points_of<d>(facet);
  if (y.size() != d)
    throw std::invalid_argument("a facet has " + std::to_string(d) + " vertices, not " +
                                std::to_string(y.size()));
  const SymmetricTensor<d> M = tensor_of<d>(metric);
  const Simplex<d> s = simplex_of<d>(simplex);
  const Circumball<d> ball(M, s);
  std::array<const Vector<d> *, d> corners;
  std::array<Bounded, d> powers;
  for (std::size_t k = 0; k < d; ++k) {
    corners[k] = &y[k];
    powers[k] = ball.power(y[k]);
    const Side side = ball.side(y[k], powers[k]);
    if (side == Side::inside)
      return true;
    if (side == Side::boundary)
      powers[k] = {};
  }
  return ball.meets(corners, powers);
}

double margin_of_facet(const Array2<double> &points, const Array3<double> &metric) {
  const auto x = points_of<3>(points);
  const auto tensors = tensors_of<3>(metric);
  if (x.size() != 5 || tensors.size() != 5)
    throw std::invalid_argument("a facet and the vertices beside it are 5 points");
  std::array<Vertex<3>, 5> vertices;
  FacetStar star;
  for (std::size_t k = 0; k < 5; ++k) {
    vertices[k] = make_vertex<3>(x[k], tensors[k]);
    star[k] = &vertices[k];
  }
  return facet_margin(star);
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
  module.def(("in_metric_sphere" + suffix).c_str(), &in_sphere<d>,
             nb::arg("metric").noconvert(), nb::arg("simplex").noconvert(),
             nb::arg("point").noconvert(),
             "Exactly: 1 inside, 0 on, -1 outside the circumscribed ellipsoid.");
  module.def(("side_of_metric_ball" + suffix).c_str(), &side_of_ball<d>,
             nb::arg("metric").noconvert(), nb::arg("simplex").noconvert(),
             nb::arg("point").noconvert(),
             "The same as in_metric_sphere, as the certificate computes it.");
  module.def(("meets_metric_ball" + suffix).c_str(), &meets_ball<d>,
             nb::arg("metric").noconvert(), nb::arg("simplex").noconvert(),
             nb::arg("facet").noconvert(),
             "Exactly: whether a facet meets the open circumscribed ellipsoid.");
}

} // namespace

void bind_certify(nb::module_ &module) {
  bind_dimension<2>(module);
  bind_dimension<3>(module);
  module.def(
      "facet_margin", &margin_of_facet, nb::arg("points").noconvert(),
      nb::arg("metric").noconvert(),
      "For the cells abcd and abce: positive when e lies inside the "
      "circumscribed ellipsoid of abcd for the metric at one of the five points.");
}

} // namespace anistar::bindings
