#pragma once
// Circumcentre refinement in the mean metric, largest circumcircle first.

#include "base/run.h"
#include "plane/mesh/workspace.h"

namespace anistar {

struct RefineCounts {
  std::size_t inserted = 0; ///< circumcentres
  std::size_t boundary_splits = 0;
  std::size_t rejected = 0; ///< too near to a vertex or a constraint

  RefineCounts &operator+=(const RefineCounts &other) {
    inserted += other.inserted;
    boundary_splits += other.boundary_splits;
    rejected += other.rejected;
    return *this;
  }
};

/// Inserts circumcentres until no cell has a circumradius above the target. It ends
/// because new vertices keep a separation in their own metric (packing).
///
/// A mesh that will be large is refined in levels, each to half the radius of the one
/// before, in blocks side by side. The blocks are others at every level, so what lies
/// between them has its turn; the rest is done at the end, in order.
RefineCounts refine(Workspace &w, const Run &run);

} // namespace anistar
