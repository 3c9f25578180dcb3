#pragma once
// The quality that a remeshing keeps.

#include "base/parallel.h"
#include "mesh/measures.h"

#include <mutex>
#include <span>

namespace anistar {

/// The least quality of the input is kept up to this: cells of that shape are good
/// enough for most solvers, and thin parts of a domain cannot always have better ones
/// of the size asked for.
inline constexpr double largest_kept_quality = .2;

/// The least quality of a mesh, as reports measure it, but no more than is kept.
template <std::size_t d>
[[nodiscard]] double kept_quality(std::span<const Vertex<d>> vertices,
                                  std::span<const Cell<d>> cells, int threads) {
  double kept = largest_kept_quality;
  std::mutex comparing;
  parallel_ranges(cells.size(), threads, [&](std::size_t begin, std::size_t end) {
    double least = largest_kept_quality;
    for (std::size_t c = begin; c < end; ++c) {
      const auto at = [&](std::size_t i) -> const Vertex<d> & {
        return vertices[cells[c][i]];
      };
      if constexpr (d == 2)
        least = std::min(least, quality(at(0), at(1), at(2)));
      else
        least = std::min(least, quality(at(0), at(1), at(2), at(3)));
    }
    const std::lock_guard lock(comparing);
    kept = std::min(kept, least);
  });
  return kept;
}

} // namespace anistar
