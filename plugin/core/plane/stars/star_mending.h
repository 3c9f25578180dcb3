#pragma once
// Vertices are moved at the few failures of the certificate that no test on one edge
// can see.

#include "base/run.h"
#include "certificate/certificate.h"
#include "plane/mesh/workspace.h"

namespace anistar {

/// Moves vertices of the inside such that fewer cells fail; no more edges disagree then
/// and the bounds of a relocation are kept.
/// @param known the answers for the mesh, before and after
/// @returns the number of moves
std::size_t mend_stars(Workspace &w, const Run &run, DelaunayBits &known);

} // namespace anistar
