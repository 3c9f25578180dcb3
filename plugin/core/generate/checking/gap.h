#pragma once
// Pieces of a complex that nearly touch.

#include "generate/checking/pieces.h"

#include <optional>

namespace anistar::generate {

/// A point close to a piece, or two close edges.
struct Gap {
  double distance;
  Vector<3> where;
  Index point;                  ///< none: two edges
  std::array<Segment, 2> edges; ///< where there is no point
};

/// The smallest gap between two pieces that is below `reach`, beyond the points that
/// they share. None where a short edge or a thin triangle spans it: that is its own
/// matter.
/// @pre The pieces do not meet.
[[nodiscard]] std::optional<Gap> gap_between(std::span<const Vector<3>> points,
                                             std::span<const Piece> pieces,
                                             const Surroundings &around, Index a,
                                             Index b, double reach);

} // namespace anistar::generate
