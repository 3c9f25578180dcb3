#pragma once
// Phase 6: Algorithms 1 to 3 of Boissonnat, Wormser, Yvinec (RR-7712 v2, section 4) on
// what agreement has left.

#include "base/run.h"
#include "plane/stars/agreement.h"
#include "plane/stars/star_mending.h"
#include "stars/rules.h"

namespace anistar {

/// Inserts points by the rules in their order until every star is Delaunay in its own
/// metric. With `relocate`, vertices are moved for agreement after every round of
/// insertions; without, only the rules of the paper act.
///
/// Differs from [1]: one valid mesh is kept instead of the star set; the simplices of
/// the star S_v are the cells that are Delaunay in M_v. Pick_valid takes the best of a
/// bounded number of points when none is valid. A round treats cells that share no
/// vertex. When it does not end consistent, the best mesh seen is left.
[[nodiscard]] ConsistencyCounts
refine_until_consistent(Workspace &w, Legaliser &legaliser, Monitor &monitor,
                        const ConsistencyParameters &parameters, Seed seed, int threads,
                        bool relocate, StarCheck &check);

} // namespace anistar
