#pragma once
// Finds what is wrong with a complex before it is meshed.

#include "base/monitor.h"
#include "generate/checking/problem.h"

#include <span>

namespace anistar::generate {

struct CheckSettings {
  std::size_t listed;   ///< problems of a kind that are named
  double near_distance; ///< that is a near-miss, in diagonals of the complex
};

/// Whether facets and edges meet in nothing but what they share, and whether they can
/// bound something. Decided by exact predicates, but for gaps and heights.
/// @pre Indices are those of points, coordinates are finite.
[[nodiscard]] Problems check(const Plc &plc, std::span<const Index> points_kept,
                             const CheckSettings &settings, Monitor &monitor);

} // namespace anistar::generate
