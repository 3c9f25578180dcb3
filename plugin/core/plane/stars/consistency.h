#pragma once
// Consistency in the plane: Algorithm 2 (see stars/algorithm_2.h) on what agreement has
// left.

#include "base/run.h"
#include "plane/mesh/workspace.h"
#include "stars/rules.h"

namespace anistar {

/// Inserts points by the rules in their order until every star is Delaunay in its own
/// metric. A round treats cells that share no vertex. With `relocate`, vertices are
/// moved for agreement after rounds of insertions; without, only the rules of the paper
/// act.
/// @param known the answers for the mesh, which has no free cells; afterwards for the
/// mesh that is left
[[nodiscard]] ConsistencyCounts
refine_until_consistent(Workspace &w, const Run &run,
                        const ConsistencyParameters &parameters, bool relocate,
                        DelaunayBits &known);

} // namespace anistar
