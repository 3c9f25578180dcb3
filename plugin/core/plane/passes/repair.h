#pragma once
// The worst cells are raised one by one.

#include "base/run.h"
#include "plane/mesh/workspace.h"
#include "plane/passes/quality_floor.h"

namespace anistar {

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
