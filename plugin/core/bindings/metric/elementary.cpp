#include "base/elementary.h"
#include "bindings/bind.h"
#include "bindings/support/arrays.h"

#include <algorithm>
#include <stdexcept>

namespace anistar::bindings {
namespace {

using Values = Array1<double>;

/// `function` of all the values.
template <class Function>
nb::ndarray<nb::numpy, double> mapped(Values values, Function function) {
  std::vector<double> out(values.size());
  {
    nb::gil_scoped_release release;
    std::transform(values.data(), values.data() + values.size(), out.begin(), function);
  }
  return owned(std::move(out), {values.size()});
}

nb::ndarray<nb::numpy, double> exp(Values values) {
  return mapped(values, [](double x) { return elementary::exp(x); });
}

nb::ndarray<nb::numpy, double> log(Values values) {
  return mapped(values, [](double x) { return elementary::log(x); });
}

nb::ndarray<nb::numpy, double> power(Values values, double exponent) {
  return mapped(values, [=](double x) { return elementary::power(x, exponent); });
}

nb::ndarray<nb::numpy, double> cosine(Values values) {
  return mapped(values, [](double x) { return elementary::sine_cosine(x).cosine; });
}

nb::ndarray<nb::numpy, double> angle_of(Values y, Values x) {
  if (x.size() != y.size())
    throw std::invalid_argument("x and y must have as many values");
  std::vector<double> out(x.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = elementary::angle_of(y.data()[i], x.data()[i]);
  return owned(std::move(out), {x.size()});
}

} // namespace

void bind_elementary(nb::module_ &module) {
  module.def("exp", &exp, nb::arg("values").noconvert(), "exp of values (n,).");
  module.def("log", &log, nb::arg("values").noconvert(),
             "Natural logarithm of values (n,).");
  module.def("power", &power, nb::arg("values").noconvert(), nb::arg("exponent"),
             "A power of values (n,) that are not negative.");
  module.def("cosine", &cosine, nb::arg("values").noconvert(),
             "Cosine of angles (n,) in radians.");
  module.def("angle_of", &angle_of, nb::arg("y").noconvert(), nb::arg("x").noconvert(),
             "The angles (n,) of the vectors (x, y), in [-pi, pi].");
}

} // namespace anistar::bindings
