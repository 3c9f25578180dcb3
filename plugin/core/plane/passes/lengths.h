#pragma once
// Edges of a length near one: short ones are collapsed, long ones are split.

#include "base/run.h"
#include "plane/mesh/workspace.h"

namespace anistar {

struct LengthCounts {
  std::size_t splits = 0, collapses = 0;

  LengthCounts &operator+=(const LengthCounts &other) {
    splits += other.splits;
    collapses += other.collapses;
    return *this;
  }
};

/// Bounds of the length of an edge.
struct LengthBounds {
  double shortest, longest;
};

/// Removes vertices with a shorter edge, then splits longer edges.
LengthCounts control_lengths(Workspace &w, const Run &run, const LengthBounds &bounds);

} // namespace anistar
