#pragma once
// What the generator meshes in the plane: points and segments (a PSLG), with what is
// said about the parts between them.

#include "generate/plc.h"

#include <span>

namespace anistar::generate {

/// What is inside where no seed says so.
enum class Inside {
  parity,  ///< what an odd number of closed loops of segments enclose
  winding, ///< what the segments wind around counter-clockwise; the number is the
           ///< region
  nonzero, ///< what they wind around in either sense
};

/// Segments meet in points they share, and nowhere else.
struct PlanarComplex {
  std::span<const Vector<2>> points;
  std::span<const Segment> segments; ///< each once
  std::span<const Index> turns; ///< how often more a segment goes along than against
  std::span<const Index> points_kept;
  std::span<const Vector<2>> seeds;
  std::span<const Index> seed_tags;
  std::span<const Vector<2>> holes;
  Inside inside = Inside::parity;
};

} // namespace anistar::generate
