#pragma once
// Phases 2 and 3 of remeshing in 3D: the mesh is brought to its size and its shape.

#include "base/stopwatch.h"
#include "volume/passes.h"

namespace anistar {

struct Shaping {
  VolumeCounts counts;
  bool is_full = false; ///< a split had to be left out for want of vertices
};

/// Splits and collapses until the edges have unit length, and improves the cells.
[[nodiscard]] Shaping shape_volume(Volume &volume, Monitor &monitor,
                                   const HausdorffNumbers &hausdorff, std::uint64_t seed,
                                   int threads, Stopwatch &watch);

} // namespace anistar
