#pragma once
// Agreement in space: the mesh is changed until the metrics of neighbours agree about
// every facet.

#include "base/run.h"
#include "stars/agreement.h"
#include "volume/mesh/volume.h"

namespace anistar {

/// Swaps, re-insertions and moves at the facets that fail the five-metric test (see
/// facet_margin), scored by the exact change in their number; where these are stuck, a
/// collapse or an insertion; then a polish of the shapes that lets no more facets fail.
/// The list of failing facets is maintained, the mesh is searched once, on several
/// threads. No quality falls below agreement_floor that was not below before.
/// @param persistence so many times the rounds and trials, for what is stuck
AgreementCounts agree(Volume &volume, const Run &run, int persistence = 1);

} // namespace anistar
