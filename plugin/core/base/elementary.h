#pragma once
// Elementary functions whose last bit does not depend on the CPU.
//
// The C library picks a variant of exp, log, pow, sin, ... by the CPU that it finds,
// and variants with fused multiply-add round differently. What is here is compiled
// once, for the instruction set of the build: the core calls nothing else.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>
#include <utility>

namespace anistar::elementary {

/// Two numbers side by side: Eigen evaluates its own exp and log on whole packets only,
/// and leaves single numbers to the C library.
using Pair = Eigen::Array2d;

/// 0 below the smallest double, where Eigen's own stays just above it.
[[nodiscard]] inline Pair exp(const Pair &x) {
  constexpr double least = -745;
  const Pair y = x.exp(); // as part of a larger expression Eigen would leave it to libm
  return Pair(x[0] < least ? 0 : y[0], x[1] < least ? 0 : y[1]);
}
[[nodiscard]] inline Pair log(const Pair &x) { return x.log(); }

[[nodiscard]] inline double exp(double x) { return exp(Pair(x, x))[0]; }
[[nodiscard]] inline double log(double x) { return log(Pair(x, x))[0]; }

[[nodiscard]] inline double log2(double x) { return log(x) * std::numbers::log2e; }
[[nodiscard]] inline double exp2(double x) { return exp(x * std::numbers::ln2); }

/// x^y for x >= 0; relative error of up to |y log x| round-offs. Exponents whose powers
/// are arithmetic or a square root are taken as such.
[[nodiscard]] inline Pair power(const Pair &x, double y) {
  const Pair one = Pair::Ones();
  if (y == 0)
    return one;
  if (y < 0 && (y == -1 || y == -2 || y == -.5))
    return one / power(x, -y);
  if (y == 1)
    return x;
  if (y == 2)
    return x * x;
  if (y == .5)
    return x.sqrt();
  const Pair exponent = y * log(x);
  return exp(exponent);
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
  std::uint64_t bits;
  std::memcpy(&bits, &a, sizeof bits);
  bits = bits / 3 + bias;
  double root;
  std::memcpy(&root, &bits, sizeof root);
  for (int step = 0; step < 3; ++step) {
    const double cube = root * root * root;
    root -= root * (cube - a) / (2 * cube + a);
  }
  return std::copysign(root, x);
}

struct SineCosine {
  double sine, cosine;
};

/// @pre |angle| is at most some hundred turns.
[[nodiscard]] inline SineCosine sine_cosine(double angle) {
  // pi / 2 in two parts; products of the first with small integers are exact
  constexpr double quarter = 0x1.921fb544p+0, quarter_rest = 0x1.0b4611a626331p-34;
  const double turns = std::nearbyint(angle * (2 / std::numbers::pi));
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
