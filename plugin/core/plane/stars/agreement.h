#pragma once
// Agreement in the plane: vertices are moved until the metrics of neighbours agree
// about every edge.

#include "base/run.h"
#include "plane/stars/relocator.h"

namespace anistar {

/// Relocates vertices at disagreeing edges, by exact scoring of the change in their
/// number, then walks on the plateau while few are left. The set of vertices to visit
/// is maintained, never searched for again. Vertices are moved in blocks, see
/// mesh/blocks.h.
AgreementCounts agree(Workspace &w, const Run &run);

} // namespace anistar
