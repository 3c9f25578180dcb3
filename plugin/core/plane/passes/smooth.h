#pragma once
// Phase 3: smoothing, split and collapse, repair of what is left.

#include "base/run.h"
#include "plane/mesh/workspace.h"
#include "plane/passes/quality_floor.h"

namespace anistar {

/// Where a vertex is drawn to.
enum class Target {
  unit_edges, ///< Bossen and Heckbert, A pliant method for anisotropic mesh generation
  odt         ///< optimal Delaunay triangulation: the mean of the circumcentres
};

/// One sweep over all vertices: each moves towards its target as far as its star stays
/// valid, takes the metric of its new place, and its edges are legalised. Vertices on a
/// curve slide along it.
///
/// Blocks are swept side by side, see mesh/blocks.h. Vertices on curves wait for the
/// end: they must not run into another part of the boundary.
void smooth(Workspace &w, const Run &run, Target target);

struct LengthCounts {
  std::size_t splits = 0, collapses = 0;
};

/// Bounds of the length of an edge.
struct LengthBounds {
  double shortest, longest;
};

/// Removes vertices with a shorter edge, then splits longer edges.
LengthCounts control_lengths(Workspace &w, const Run &run, const LengthBounds &bounds);

struct RepairRule {
  QualityFloor floor; ///< cells below it are repaired
  /// Whether edges may become short, and may be split and collapsed whatever their
  /// length: where unit edges make poor cells.
  bool at_any_length = false;
};

/// Raises the worst cells: around every cell below the floor swaps, moves, collapses
/// and splits that raise the minimum quality, for a few rounds. @returns the number of
/// cells below it when the last round met them.
std::size_t repair(Workspace &w, const Run &run, const RepairRule &rule);

} // namespace anistar
