#pragma once
// Algorithms 4 and 5 of RR-7712 (section 7.1) on a star set.

#include "volume/pure/merge.h"
#include "volume/pure/pick_valid.h"
#include "volume/pure/ridge_edges.h"

namespace anistar {

struct RefinedStarSet {
  ConsistencyCounts counts;
  MergedMesh merged; ///< empty unless the stars are consistent
};

/// Inserts points by the eight rules in their order until no simplex breaks one, or a
/// bound ends it.
///
/// Consistent stars are no mesh where a surface and its cells do not fit each other, as
/// at small dihedral angles, where circumcentres leave the domain. There the largest
/// facets are refined, like those with a topological defect, some rounds long.
///
/// Points on surfaces, by rules 1 to 3 and 7 and where a point for a cell would have
/// encroached upon a facet, count as `boundary`; a round is an insertion.
[[nodiscard]] RefinedStarSet refine_star_set(StarSet &stars, RidgeEdges &ridges,
                                             const Run &run,
                                             const ConsistencyParameters &parameters);

} // namespace anistar
