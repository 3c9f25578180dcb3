#include "bindings/for_tests/bind.h"
#include "bindings/support/geometry.h"
#include "certificate/circumball.h"
#include "certificate/facet_test.h"

namespace anistar::bindings {
namespace {

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

void bind_predicates(nb::module_ &module) {
  bind_dimension<2>(module);
  bind_dimension<3>(module);
  module.def("facet_margin", &margin_of_facet, nb::arg("points").noconvert(),
             nb::arg("metric").noconvert(),
             "For the cells abcd and abce: positive when e lies inside the "
             "circumscribed ellipsoid of abcd for the metric at one of the "
             "five points.");
}

} // namespace anistar::bindings
