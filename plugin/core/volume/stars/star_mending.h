#pragma once
// Vertices are moved at the few failures of the certificate that no test on one facet
// can see.

#include "base/run.h"
#include "certificate/certificate.h"
#include "volume/mesh/volume.h"

namespace anistar {

/// Moves vertices such that fewer cells fail; no more facets fail then, no quality
/// falls below agreement_floor and no edge becomes worse. Vertices on surfaces and
/// ridges slide along them.
/// @param known the answers for the mesh, before and after
/// @returns the number of moves
std::size_t mend_stars(Volume &volume, const Run &run, DelaunayBits &known);

} // namespace anistar
