#pragma once
// Circumcentre refinement in the mean metric, largest circumcircle first.

#include "edits.h"
#include "flips.h"
#include "monitor.h"

namespace anistar {

struct RefineCounts {
  std::size_t inserted = 0; ///< circumcentres
  std::size_t boundary_splits = 0;
  std::size_t rejected = 0; ///< too near to a vertex or a constraint
};

/// Inserts circumcentres until no cell has a circumradius above the target. It ends
/// because new vertices keep a separation in their own metric (packing).
RefineCounts refine(Workspace &w, Legaliser &legaliser, Monitor &monitor);

} // namespace anistar
