#pragma once
// Longest-edge bisection of cells that are poor whatever their vertices do: between
// walls nearer to each other than the size asked for, and where the metric varies more
// within a cell than unit edges allow.

#include "base/run.h"
#include "plane/mesh/workspace.h"
#include "plane/passes/quality_floor.h"

namespace anistar {

/// Repairs the cells below a floor, and splits an edge of each that stays below, in
/// turns, as long as that leads on. A long wall is split first; else the longest edge
/// in the metric of the cell, but the longest one of the cell beyond before that, where
/// it is longer (Rivara, New longest-edge algorithms for the refinement and/or
/// improvement of unstructured triangulations, 1997).
/// @returns how many edges were split.
std::size_t bisect(Workspace &w, const Run &run, QualityFloor floor);

} // namespace anistar
