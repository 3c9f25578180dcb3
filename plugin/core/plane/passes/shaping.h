#pragma once
// The passes that shape a mesh of the right size, in their order.

#include "plane/passes/lengths.h"
#include "plane/passes/quality_floor.h"

namespace anistar {

/// What the passes that shape the cells did.
struct ShapeCounts {
  LengthCounts lengths;
  std::size_t poor = 0; ///< cells that repair met last
  std::size_t bisections = 0;
};

/// Sweeps of smoothing and control of lengths in turns, then repair of what is left,
/// and bisection of the cells below a floor. @pre the mesh was renumbered.
ShapeCounts shape(Workspace &w, const Run &run, const QualityFloor &floor);

} // namespace anistar
