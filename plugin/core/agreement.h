#pragma once
// Phase 4: vertices are moved until the metrics of neighbours agree about every edge.

#include "certificate.h"
#include "edits.h"
#include "flips.h"
#include "monitor.h"

#include <cstdint>

namespace anistar {

struct AgreementCounts {
  std::size_t edges_before = 0, edges_after = 0; ///< on which four metrics disagree
  std::size_t trials = 0, moves = 0;
  std::size_t star_failures = 0; ///< cells that the star check found after it
  std::size_t star_repairs = 0;  ///< moves that mended them
};

/// Whether an edge is not Delaunay in the metric of one of the four vertices of its two
/// cells: the local test, necessary for a certificate (the in-sphere determinant is
/// linear in the metric, so one coefficient vector serves all four).
[[nodiscard]] bool disagrees(const Triangulation<2> &mesh, HalfFacet edge);

/// Relocates vertices at disagreeing edges, by exact scoring of the change in their
/// number, then walks on the plateau while few are left. The set of vertices to visit
/// is maintained, never searched for again.
AgreementCounts agree(Workspace &w, Legaliser &legaliser, Monitor &monitor,
                      std::uint64_t seed);

/// Checks every star and moves vertices at the failures that the local test cannot see.
/// @returns the bits of the final mesh, cell by cell.
std::vector<std::uint8_t> check_stars(Workspace &w, Monitor &monitor,
                                      std::uint64_t seed, int threads,
                                      AgreementCounts &counts);

} // namespace anistar
