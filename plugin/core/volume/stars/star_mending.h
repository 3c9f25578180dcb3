#pragma once
// Vertices are moved at the failures of the certificate that no test on one facet can
// see.

#include "base/run.h"
#include "certificate/certificate.h"
#include "volume/stars/agreement.h"

namespace anistar {

/// Moves vertices by directed steps such that fewer cells fail: a vertex inside of the
/// ball of a cell that is no neighbour of its is watched like a facet from then on (see
/// FarViolations). No more facets fail then, no quality falls below agreement_floor and
/// no edge becomes worse. Vertices on surfaces and ridges slide along them.
/// @param effort tells how many cells may fail for it to begin
/// @param known the answers for the mesh, before and after
MendingCounts mend_stars(Volume &volume, const Run &run, const AgreementEffort &effort,
                         DelaunayBits &known);

} // namespace anistar
