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
      const auto [sine, cosine] =
          elementary::sine_cosine(2 * std::numbers::pi * random.uniform());
      return product<2>(root_, Vector<2>(r * cosine, r * sine));
    } else {
      const double r = radius * elementary::cube_root(random.uniform());
      const auto [sine, cosine] =
          elementary::sine_cosine(2 * std::numbers::pi * random.uniform());
      const double height = 2 * random.uniform() - 1;
      const double flat = r * std::sqrt(1 - height * height);
      return product<3>(root_, Vector<3>(flat * cosine, flat * sine, r * height));
    }
  }

private:
  SymmetricTensor<d> root_; ///< M^(-1/2)
};

} // namespace anistar
