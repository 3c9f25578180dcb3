#pragma once
// Short steps of a vertex that satisfy linear bounds.

#include "base/tensor.h"

#include <span>

namespace anistar {

/// value + slope . y <= 0 for the step y.
struct LinearBound {
  double value;
  Vector<3> slope;
};

/// A short step that satisfies the bounds, as far as it finds one within a radius: from
/// one violated bound to the next by projection (Kaczmarz).
[[nodiscard]] Vector<3> short_step(std::span<const LinearBound> bounds, double radius, Vector<3> y = Vector<3>::Zero());

} // namespace anistar
