#pragma once
// Numbers that carry a bound of their error through a formula, for filters.

#include <cmath>

namespace anistar {

/// A rounded value that is off by at most `error`.
struct Bounded {
  double value = 0, error = 0;

  /// Twice the unit round-off: covers the rounding of the bounds as well.
  static constexpr double rounding = 0x1p-52;
  /// Products below this may have lost bits to underflow.
  static constexpr double underflow = 1e-300;

  [[nodiscard]] bool is_positive() const { return value > error; }
  [[nodiscard]] bool is_negative() const { return value < -error; }
  [[nodiscard]] Bounded operator-() const { return {-value, error}; }
};

[[nodiscard]] inline Bounded operator+(const Bounded &a, const Bounded &b) {
  const double sum = a.value + b.value;
  return {sum, a.error + b.error + Bounded::rounding * std::abs(sum)};
}
[[nodiscard]] inline Bounded operator-(const Bounded &a, const Bounded &b) {
  return a + -b;
}
[[nodiscard]] inline Bounded operator*(const Bounded &a, const Bounded &b) {
  const double product = a.value * b.value;
  return {product, std::abs(a.value) * b.error + std::abs(b.value) * a.error +
                       a.error * b.error + Bounded::rounding * std::abs(product) +
                       Bounded::underflow};
}
/// Exact: a power of two.
[[nodiscard]] inline Bounded twice(const Bounded &a) {
  return {2 * a.value, 2 * a.error};
}

} // namespace anistar
