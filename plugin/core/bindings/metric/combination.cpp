#include "metric/combination.h"
#include "bindings/bind.h"
#include "bindings/support/arrays.h"

#include <stdexcept>

namespace anistar::bindings {
namespace {

nb::ndarray<nb::numpy, double> intersect(Array3<double> first, Array3<double> second) {
  const std::size_t n = first.shape(0), d = first.shape(1);
  if ((d != 2 && d != 3) || first.shape(2) != d || second.shape(0) != n ||
      second.shape(1) != d || second.shape(2) != d)
    throw std::invalid_argument("metrics must have one shape (n, 2, 2) or (n, 3, 3)");
  const std::span<const double> M(first.data(), first.size());
  const std::span<const double> N(second.data(), second.size());
  std::vector<double> result;
  {
    nb::gil_scoped_release release;
    result = d == 2 ? intersected<2>(M, N) : intersected<3>(M, N);
  }
  return owned(std::move(result), {n, d, d});
}

} // namespace

void bind_combination(nb::module_ &module) {
  module.def("intersect", &intersect, nb::arg("first").noconvert(),
             nb::arg("second").noconvert(),
             "Intersect two fields of metrics (n, d, d) by simultaneous reduction.");
}

} // namespace anistar::bindings
