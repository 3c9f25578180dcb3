#pragma once
// A mesh of a domain by the algorithm of the paper, from its boundary alone.

#include "volume/pure/merge.h"

#include "base/run.h"
#include "stars/rules.h"
#include "volume/pure/site.h"

namespace anistar {

struct StarSetMesh {
  ConsistencyCounts counts;
  std::size_t n_sites = 0; ///< when it ended
  MergedMesh merged;       ///< empty unless the stars are consistent

  [[nodiscard]] bool exists() const {
    return counts.stop == ConsistencyStop::consistent;
  }
};

/// Boissonnat, Wormser, Yvinec, RR-7712 v2, section 7: protected ridges, a few sites on
/// every surface, and refinement by Algorithms 4 and 5.
/// @param start the input mesh on its surfaces and ridges
/// @param region of its cells, in the order of the background
[[nodiscard]] StarSetMesh mesh_by_stars(const Volume &start,
                                        std::span<const Index> region, const Run &run,
                                        const ConsistencyParameters &parameters);

} // namespace anistar
