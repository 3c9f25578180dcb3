#pragma once
// Phase 6 in 3D: Algorithms 1 to 3 of Boissonnat, Wormser, Yvinec (RR-7712 v2,
// section 4) on one valid mesh of tetrahedra.

#include "base/run.h"
#include "stars/rules.h"
#include "volume/mesh/volume.h"

namespace anistar {

/// Inserts points by the rules in their order, and moves vertices, until every star is
/// Delaunay in its own metric.
///
/// Differs from [1]: one valid mesh is kept instead of the star set; the simplices of
/// the star S_v are the cells that are Delaunay in M_v. Pick_valid takes the best of a
/// bounded number of points: the fewest slivers, then the lowest AgreementCost. A round
/// treats bad cells of all rules, the first rule first, that share no vertex. At each
/// of them a vertex is moved if that makes fewer facets fail, else a point is inserted
/// that does; what is stuck is tried harder, and
/// goes through agreement and the star check again. When it does not end consistent,
/// the best mesh seen is left.
///
/// @param hausdorff_number of curved surfaces, as in VolumePasses
/// @param known the answers for the mesh, which has no free cells; afterwards for the
/// mesh that is left
[[nodiscard]] ConsistencyCounts refine_until_consistent(
    Volume &volume, Monitor &monitor, const ConsistencyParameters &parameters,
    double hausdorff_number, Seed seed, int threads, DelaunayBits &known);

} // namespace anistar
