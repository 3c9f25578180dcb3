#include "bindings/for_tests/bind.h"
#include "bindings/support/geometry.h"
#include "volume/stars/step_bounds.h"

namespace anistar::bindings {
namespace {

auto slope_of_facet(const Array2<double> &points, const Array3<double> &metric,
                    std::size_t moved) {
  const auto x = points_of<3>(points);
  const auto M = tensors_of<3>(metric);
  if (x.size() != 5 || M.size() != 5 || moved >= 5)
    throw std::invalid_argument("a facet and the vertices beside it are 5 points");
  std::array<Vertex<3>, 5> vertices;
  FacetStar star;
  for (std::size_t k = 0; k < 5; ++k) {
    vertices[k] = make_vertex<3>(x[k], M[k]);
    star[k] = &vertices[k];
  }
  const FacetSlope found = facet_slope(star, moved);
  const Vector<3> &g = found.gradient;
  return nb::make_tuple(found.margin, nb::make_tuple(g[0], g[1], g[2]));
}

auto projected(const Array1<double> &values, const Array2<double> &slopes,
               const Array1<double> &wanted, double radius) {
  const auto slope = points_of<3>(slopes);
  if (values.shape(0) != slope.size() || wanted.shape(0) != 3)
    throw std::invalid_argument("values, slopes and the wanted point do not fit");
  std::vector<LinearBound> bounds;
  for (std::size_t k = 0; k < slope.size(); ++k)
    bounds.push_back({.value = values(k), .slope = slope[k]});
  const Vector<3> y =
      project(bounds, Eigen::Map<const Vector<3>>(wanted.data()), radius);
  return nb::make_tuple(y[0], y[1], y[2]);
}

} // namespace

void bind_directed_steps(nb::module_ &module) {
  module.def("facet_slope", &slope_of_facet, nb::arg("points").noconvert(),
             nb::arg("metric").noconvert(), nb::arg("moved"),
             "The margin of a facet, rounded, and its gradient with respect to one of "
             "the five points.");
  module.def("project", &projected, nb::arg("values").noconvert(),
             nb::arg("slopes").noconvert(), nb::arg("wanted").noconvert(),
             nb::arg("radius"),
             "The point near to the wanted one where value + slope . y <= 0 for all.");
}

} // namespace anistar::bindings
