#pragma once
// Agreement in space: the mesh is changed until the metrics of neighbours agree about
// every facet.

#include "base/run.h"
#include "stars/agreement.h"
#include "volume/mesh/volume.h"

namespace anistar {

/// How much is tried where directed steps find nothing more.
struct AgreementEffort {
  double trials_per_cell; ///< places
  double mended_part;     ///< cells are mended when no more of them fail than this part
  int patience = 1;       ///< so many times the rounds and trials
};
/// What a mesh gets unasked: the directed steps and a little more.
inline constexpr AgreementEffort small_effort{.trials_per_cell = .25,
                                              .mended_part = .005};
/// As long as it helps. A bound on the trial places: the metrics that could be
/// certified, but for a few cells, took a third of it.
inline constexpr AgreementEffort full_effort{.trials_per_cell = 20, .mended_part = .03};

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
