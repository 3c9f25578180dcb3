#pragma once
// Elementary functions whose last bit does not depend on the CPU.
//
// The C library picks a variant of exp, log, pow, sin, ... by the CPU that it finds,
// and variants with fused multiply-add round differently. What is here is compiled
// once, for the instruction set of the build: the core calls nothing else. Eigen's
// vectorised exp and log would do as well, but take three times as long without SSE4.1.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

namespace anistar::elementary {

namespace detail {
/// log 2 in two parts; products of the first with exponents of doubles are exact.
inline constexpr double ln2 = 0x1.62e42fee00000p-1, ln2_rest = 0x1.a39ef35793c76p-33;

[[nodiscard]] inline double power_of_two(std::int64_t exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52);
}
} // namespace detail

/// Within one unit of the last place; 0 below the smallest double.
[[nodiscard]] inline double exp(double x) {
  constexpr double lowest = -746, highest = 710;
  constexpr double shift = 0x1.8p52; // added and taken away it rounds to an integer
  x = std::min(std::max(x, lowest), highest);
  const double shifted = x * std::numbers::log2e + shift, n = shifted - shift;
  const double r = (x - n * detail::ln2) - n * detail::ln2_rest;
  // Taylor series; |r| <= log(2) / 2, so that the first term left out is below 5e-18
  constexpr double c[] = {1.,
                          1.,
                          1. / 2,
                          1. / 6,
                          1. / 24,
                          1. / 120,
                          1. / 720,
                          1. / 5040,
                          1. / 40320,
                          1. / 362880,
                          1. / 3628800,
                          1. / 39916800,
                          1. / 479001600,
                          1. / 6227020800.};
  const double r2 = r * r, r4 = r2 * r2;
  const double high = ((c[6] + c[7] * r) + r2 * (c[8] + c[9] * r)) +
                      r4 * ((c[10] + c[11] * r) + r2 * (c[12] + c[13] * r));
  const double low = (c[2] + c[3] * r) + r2 * (c[4] + c[5] * r);
  const double value = c[0] + (c[1] * r + r2 * (low + r4 * high));
  const auto exponent = static_cast<std::int64_t>(
      std::bit_cast<std::uint64_t>(shifted) - std::bit_cast<std::uint64_t>(shift));
  // in two steps: near the ends of the range one factor is no normal double
  const std::int64_t half = exponent >> 1;
  return value * detail::power_of_two(half) * detail::power_of_two(exponent - half);
}

/// Within one unit of the last place; NaN of negative numbers.
[[nodiscard]] inline double log(double x) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!(x > 0) || x == infinity)
    return x == 0 ? -infinity : x > 0 ? x : std::numeric_limits<double>::quiet_NaN();
  double exponent = 0;
  if (x < std::numeric_limits<double>::min()) {
    x *= 0x1p54;
    exponent = -54;
  }
  // x = m 2^k with m in [sqrt(1/2), sqrt(2)): m's bits start from those of sqrt(1/2)
  constexpr std::uint64_t start = 0x3FE6A09E00000000;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x) - start;
  const std::int64_t k = static_cast<std::int64_t>(bits) >> 52;
  exponent += static_cast<double>(k);
  const double f = std::bit_cast<double>((bits & 0x000FFFFFFFFFFFFF) + start) - 1;
  // log m = 2 atanh s = f - s (f - R), R the rest of the series of 2 atanh s / s beyond
  // 2; |s| < .172, so that the first term left out is below 2e-18
  const double s = f / (2 + f), z = s * s, z2 = z * z, z4 = z2 * z2;
  constexpr double c[] = {2. / 3,  2. / 5,  2. / 7,  2. / 9,  2. / 11,
                          2. / 13, 2. / 15, 2. / 17, 2. / 19, 2. / 21};
  const double rest =
      z *
      (((c[0] + c[1] * z) + z2 * (c[2] + c[3] * z)) +
       z4 * (((c[4] + c[5] * z) + z2 * (c[6] + c[7] * z)) + z4 * (c[8] + c[9] * z)));
  return exponent * detail::ln2 + (f - (s * (f - rest) - exponent * detail::ln2_rest));
}

[[nodiscard]] inline double log2(double x) { return log(x) * std::numbers::log2e; }
[[nodiscard]] inline double exp2(double x) { return exp(x * std::numbers::ln2); }

/// x^y for x >= 0; relative error of up to |y log x| round-offs. Exponents whose powers
/// are arithmetic or a square root are taken as such.
[[nodiscard]] inline double power(double x, double y) {
  if (y == 0)
    return 1;
  if (y == -1 || y == -2 || y == -.5)
    return 1 / power(x, -y);
  if (y == 1)
    return x;
  if (y == 2)
    return x * x;
  if (y == .5)
    return std::sqrt(x);
  return exp(y * log(x));
}

/// The length of (x, y), also where its square leaves the range of doubles.
[[nodiscard]] inline double length(double x, double y) {
  constexpr double smallest = 1e-290, largest = 1e290;
  const double square = x * x + y * y;
  if (square > smallest && square < largest)
    return std::sqrt(square);
  const double size = std::max(std::abs(x), std::abs(y));
  if (!(size > 0) || size > std::numeric_limits<double>::max())
    return size;
  const double u = x / size, v = y / size;
  return size * std::sqrt(u * u + v * v);
}

/// Cube root: a third of the exponent as the guess, then steps of Halley, which take an
/// error of e to about e^3.
[[nodiscard]] inline double cube_root(double x) {
  constexpr std::uint64_t bias = 0x2A9F7893782DA1CE; // two thirds of that of doubles
  constexpr double smallest = 0x1p-900;              // cubes of smaller roots lose bits
  const double a = std::abs(x);
  if (a < smallest && a > 0)
    return cube_root(x * 0x1p+300) * 0x1p-100;
  if (!(a > 0) || a > std::numeric_limits<double>::max())
    return x; // 0, infinite or NaN
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(a) / 3 + bias;
  double root = std::bit_cast<double>(bits);
  for (int step = 0; step < 3; ++step) {
    const double cube = root * root * root;
    root -= root * (cube - a) / (2 * cube + a);
  }
  return std::copysign(root, x);
}

struct SineCosine {
  double sine, cosine;
};

/// NaN of angles that are not finite, or beyond a quarter of a million turns.
[[nodiscard]] inline SineCosine sine_cosine(double angle) {
  // pi / 2 in two parts; products of the first with integers below `largest` are exact
  constexpr double quarter = 0x1.921fb544p+0, quarter_rest = 0x1.0b4611a626331p-34;
  constexpr double largest = 0x1p20, none = std::numeric_limits<double>::quiet_NaN();
  const double turns = std::nearbyint(angle * (2 / std::numbers::pi));
  if (!(std::abs(turns) < largest))
    return {none, none};
  const double r = (angle - turns * quarter) - turns * quarter_rest;
  const double square = r * r;
  // Taylor series; |r| <= pi / 4, so that the first terms left out are below 1e-17
  double sine = 0, cosine = 0;
  for (int k = 8; k >= 1; --k) {
    sine = (1 + sine) * (-square / (2 * k * (2 * k + 1)));
    cosine = (1 + cosine) * (-square / (2 * k * (2 * k - 1)));
  }
  sine = r + r * sine;
  cosine = 1 + cosine;
  switch (static_cast<std::int64_t>(turns) & 3) {
  case 0:
    return {sine, cosine};
  case 1:
    return {cosine, -sine};
  case 2:
    return {-sine, -cosine};
  default:
    return {-cosine, sine};
  }
}

/// The angle of (x, y) in [-pi, pi]; 0 for the zero vector.
[[nodiscard]] inline double angle_of(double y, double x) {
  const double size = std::max(std::abs(x), std::abs(y));
  if (size == 0)
    return std::signbit(x) ? std::copysign(std::numbers::pi, y) : y;
  const double u = std::abs(x) / size, v = std::abs(y) / size;
  // within .004 of the angle: then the tangent of what is missing, and its series
  const double t = std::min(u, v);
  double angle = t * (std::numbers::pi / 4 + .273 * (1 - t));
  if (v > u)
    angle = std::numbers::pi / 2 - angle;
  const auto [sine, cosine] = sine_cosine(angle);
  const double e = (v * cosine - u * sine) / (u * cosine + v * sine), e2 = e * e;
  angle += e - e * e2 * (1. / 3 - e2 * (1. / 5 - e2 / 7));
  if (std::signbit(x))
    angle = std::numbers::pi - angle;
  return std::copysign(angle, y);
}

} // namespace anistar::elementary
