#pragma once
// Phase 5: every star is checked, and vertices are moved at the failures that no local
// test can see.

#include "base/run.h"
#include "certificate/certificate.h"
#include "plane/mesh/edits.h"

#include <cstdint>
#include <vector>

namespace anistar {

struct StarCheck {
  std::vector<std::uint8_t> bits; ///< of the final mesh, see delaunay_bits
  std::size_t failures = 0;       ///< cells that failed at first
  std::size_t moves = 0;          ///< that mended some
  double simplex_ok = 0;          ///< fraction of cells Delaunay in all their metrics
  double star_ok = 0;             ///< fraction of stars whose cells are in its metric
};

/// @pre the mesh has no free cells (sort_along_curve was its last change of topology).
[[nodiscard]] StarCheck check_stars(Workspace &w, Monitor &monitor, Seed seed,
                                    int threads, bool mend);

} // namespace anistar
