#pragma once
// The schedule of the passes: the mesh is brought to its size, and then to its shape.

#include "base/stopwatch.h"
#include "volume/passes/passes.h"

#include <functional>
#include <memory>

namespace anistar {

struct Shaping {
  std::unique_ptr<Volume> volume;
  VolumeCounts counts;
  bool is_full = false; ///< a split had to be left out for want of vertices
  double kept = 0;      ///< what its quality should not be below (see kept_quality.h)
  double least = 0;     ///< of its qualities, in the mean of the metrics
};

/// Splits and collapses until the edges have unit length, and improves the cells.
///
/// No step at the final size lowers the least quality below what is kept. Where that is
/// not enough another mesh is made which keeps it all the time, and the better one is
/// returned.
/// @param start makes the mesh that it begins with
[[nodiscard]] Shaping shape_volume(const std::function<Volume()> &start, const Run &run,
                                   Stopwatch &watch);

} // namespace anistar
