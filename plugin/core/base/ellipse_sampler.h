#pragma once
// Random points of the unit ball of a metric.

#include "base/random.h"
#include "base/tensor.h"

#include <numbers>

namespace anistar {

template <std::size_t d> class EllipseSampler {
public:
  explicit EllipseSampler(const SymmetricTensor<d> &M)
      : root_(matrix_function(M, [](double x) { return 1 / std::sqrt(x); })) {}

  /// Uniform in the ball of this radius about the origin.
  [[nodiscard]] Vector<d> step(double radius, CounterRandom &random) const {
    if constexpr (d == 2) {
      const double r = radius * std::sqrt(random.uniform());
      const double angle = 2 * std::numbers::pi * random.uniform();
      return product<2>(root_, Vector<2>(r * std::cos(angle), r * std::sin(angle)));
    } else {
      const double r = radius * std::cbrt(random.uniform());
      const double angle = 2 * std::numbers::pi * random.uniform();
      const double height = 2 * random.uniform() - 1;
      const double flat = r * std::sqrt(1 - height * height);
      return product<3>(
          root_, Vector<3>(flat * std::cos(angle), flat * std::sin(angle), r * height));
    }
  }

private:
  SymmetricTensor<d> root_; ///< M^(-1/2)
};

} // namespace anistar
