#include "bindings/for_tests/bind.h"
#include "bindings/support/geometry.h"
#include "volume/mesh/densest_shapes.h"

namespace anistar::bindings {
namespace {

/// Rows of four vertices each.
nb::ndarray<nb::numpy, double> tet_qualities(const Array2<double> &points,
                                             const Array3<double> &metric) {
  const auto x = points_of<3>(points);
  const auto M = tensors_of<3>(metric);
  if (x.size() != M.size() || x.size() % 4 != 0)
    throw std::invalid_argument("points and metrics of tetrahedra come in fours");
  std::vector<double> out;
  out.reserve(x.size() / 4 * 3);
  for (std::size_t k = 0; k < x.size(); k += 4) {
    std::array<Vertex<3>, 4> v;
    for (std::size_t i = 0; i < 4; ++i)
      v[i] = make_vertex<3>(x[k + i], M[k + i]);
    StarShapes star;
    star.clear();
    star.add(v[0], v[1], v[2]);
    star.evaluate(v[3]);
    DensestShapes densest;
    densest.add(v[0], v[1], v[2]);
    densest.evaluate(v[3], 0);
    out.push_back(shape_quality(v[0], v[1], v[2], v[3]));
    out.push_back(static_cast<double>(star.quality(0)));
    out.push_back(densest.minimum());
  }
  return owned(std::move(out), {x.size() / 4, 3});
}

} // namespace

void bind_tet_shape(nb::module_ &module) {
  module.def("tet_qualities", &tet_qualities, nb::arg("points").noconvert(),
             nb::arg("metric").noconvert(),
             "Mean ratios (m, 3) of tetrahedra given by four points each: in "
             "the mean of "
             "the metrics, the same for a moving vertex, in the densest; -1 "
             "when flat.");
}

} // namespace anistar::bindings
