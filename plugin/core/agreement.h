#pragma once
// Phase 4: vertices are moved until the metrics of neighbours agree about every edge.

#include "edits.h"
#include "flips.h"
#include "monitor.h"

#include <cstdint>

namespace anistar {

struct AgreementCounts {
  std::size_t edges_before = 0, edges_after = 0; ///< on which four metrics disagree
  std::size_t trials = 0, moves = 0;

  AgreementCounts &operator+=(const AgreementCounts &other) {
    edges_before += other.edges_before;
    edges_after += other.edges_after;
    trials += other.trials;
    moves += other.moves;
    return *this;
  }
};

/// Relocates vertices at disagreeing edges, by exact scoring of the change in their
/// number, then walks on the plateau while few are left. The set of vertices to visit
/// is maintained, never searched for again. Vertices are moved in blocks, see blocks.h.
AgreementCounts agree(Workspace &w, Legaliser &legaliser, Monitor &monitor,
                      std::uint64_t seed, int threads);

} // namespace anistar
