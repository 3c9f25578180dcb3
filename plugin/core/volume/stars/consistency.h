#pragma once
// Consistency in space: Algorithm 2 (see stars/algorithm_2.h) on what agreement has
// left.

#include "base/run.h"
#include "remesh/remesh_settings.h"
#include "volume/mesh/volume.h"

namespace anistar {

/// Inserts points by the rules in their order, and moves vertices, until every star is
/// Delaunay in its own metric. Pick_valid takes the fewest slivers, then the lowest
/// AgreementCost. A round treats bad cells of all rules, the first rule first, that
/// share no vertex. At each of them a vertex is moved if that makes fewer facets fail,
/// else a point is inserted that does; what is stuck is tried harder, and goes through
/// agreement and mending again. Facets are judged as the certificate judges them, by
/// the surfaces that the mesh itself shows.
/// @param known the answers for the mesh, which has no free cells; afterwards for the
/// mesh that is left
[[nodiscard]] ConsistencyCounts refine_until_consistent(Volume &volume, const Run &run,
                                                        const RemeshSettings &settings,
                                                        DelaunayBits &known);

} // namespace anistar
