#include "volume/stars/directed_step.h"

#include <algorithm>
#include <cmath>

namespace anistar {
namespace {

constexpr int max_sweeps = 30;
/// A projection goes so much further: it would only come near the bound.
constexpr double relaxation = 1.05;
/// Bounds with smaller slopes, squared, do not depend on the step.
constexpr double smallest_square = 1e-12;

} // namespace

Vector<3> short_step(std::span<const LinearBound> bounds, double radius, Vector<3> y) {
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    bool is_done = true;
    for (const LinearBound &bound : bounds) {
      const double excess = bound.value + bound.slope.dot(y);
      const double square = bound.slope.squaredNorm();
      if (excess <= 0 || square < smallest_square)
        continue;
      is_done = false;
      y -= std::min(relaxation * excess / square, radius / std::sqrt(square)) *
           bound.slope;
    }
    const double length = y.norm();
    if (length > radius)
      y *= radius / length;
    if (is_done)
      break;
  }
  return y;
}

} // namespace anistar
