#pragma once
// Phase 6 in 3D: Algorithms 1 to 3 of Boissonnat, Wormser, Yvinec (RR-7712 v2,
// section 4) on one valid mesh of tetrahedra.

#include "consistency_rules.h"
#include "monitor.h"
#include "volume.h"

namespace anistar {

/// Inserts points by the rules in their order until every star is Delaunay in its own
/// metric. With `relocate`, vertices are moved for agreement after every round of
/// insertions.
///
/// Differs from [1] as refine_until_consistent in 2D does, and in two more ways. A
/// round treats bad cells of all rules, the first rule first. A point enters only if it
/// does not make more facets on which metrics disagree than an allowance that grows
/// while rounds bring nothing.
///
/// @param known the answers for the mesh, which has no free cells; for the mesh that is
/// left afterwards
[[nodiscard]] ConsistencyCounts
refine_until_consistent(Volume &volume, Monitor &monitor,
                        const ConsistencyParameters &parameters, std::uint64_t seed,
                        int threads, bool relocate, DelaunayBits &known);

/// The mesh as the certificate sees it.
[[nodiscard]] inline CertifiedMesh<3> certified(const Triangulation<3> &mesh) {
  return {mesh.vertices, mesh.cells, mesh.neighbours, mesh.constraints};
}

} // namespace anistar
