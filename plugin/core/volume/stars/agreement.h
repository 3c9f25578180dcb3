#pragma once
// Agreement in space: the mesh is changed until the metrics of neighbours agree about
// every facet.

#include "base/run.h"
#include "volume/mesh/volume.h"
#include "volume/stars/agreement_effort.h"

namespace anistar {

/// Directed steps of the vertices of facets that fail the five-metric test (see
/// facet_margin); then, at what is left, swaps, re-insertions and random moves, scored
/// by the exact change in the number of failing facets, and collapses and insertions.
/// Shapes are polished in between and at the end, such that no more facets fail. The
/// list of failing facets is maintained, the mesh is searched once, on several threads.
/// No quality falls below agreement_floor that was not below before.
AgreementCounts agree(Volume &volume, const Run &run, const AgreementEffort &effort);

/// Lets the stars of a mesh rest (see VolumeMesh::at_rest) that agrees but for a few
/// facets and has edges of unit length: a converged mesh stays as it is.
void rest_where_agreed(Volume &volume, const Run &run);

} // namespace anistar
