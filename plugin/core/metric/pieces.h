#pragma once
// Into how many pieces a metric divides the edges of the mesh that carries it.

#include "base/tensor.h"
#include "mesh/adjacency.h"

#include <span>
#include <vector>

namespace anistar {

/// One entry a point, at least 1.
struct Pieces {
  std::vector<double> most;   ///< of its longest edge, in its own metric
  std::vector<double> fewest; ///< the least of that over the point and its neighbours
};

template <std::size_t d>
[[nodiscard]] Pieces pieces_at(std::span<const Vector<d>> points,
                               std::span<const Cell<d>> cells,
                               std::span<const SymmetricTensor<d>> metric);

} // namespace anistar
