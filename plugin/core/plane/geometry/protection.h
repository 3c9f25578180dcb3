#pragma once
// Protecting balls at sharp corners.

#include "base/run.h"
#include "plane/geometry/length_table.h"

#include <optional>
#include <span>
#include <vector>

namespace anistar {

/// Where a curve meets the protecting ball of a corner; on a curve that is one
/// protected edge, that is its other end.
struct Shell {
  double parameter;
  Index ball;
};

/// The shells of the corners at the two ends of a curve.
struct Shells {
  std::optional<Shell> first, last;
};

struct Protection {
  std::vector<Shells> shells; ///< per curve
  Index n_balls = 0;
  std::size_t given_up = 0; ///< groups of legs that found no common length
};

/// Where legs, the curves at a corner, enclose a part of the domain in a sharp angle,
/// their first vertices are put on one ball around the corner, in the metric M of the
/// corner: the cell in the tip is isosceles there, and no refinement of one leg makes
/// the other too long (concentric shells: Ruppert 1995, Shewchuk 2000). Legs on the two
/// sides of a common sharp sector share a radius, and so on around the corner.
///
/// The radius is the one near 1 that leaves the edges of the legs nearest to unit
/// length; legs too short for a common one are left alone.
/// @param lengths table of every curve
/// @throws BudgetSpent when the time is up
[[nodiscard]] Protection protect_corners(const Geometry &geometry,
                                         const Background<2> &background,
                                         std::span<const LengthTable> lengths,
                                         const Run &run);

} // namespace anistar
