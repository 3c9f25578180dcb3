#pragma once
// Polygon facets of a complex, as they are given.

#include "mesh/adjacency.h"

#include <cstdint>
#include <span>

namespace anistar::generate {

/// The loops of all facets, one after the other. The first loop of a facet is the outer
/// one; after it, loops of three or more points are holes, those of two edges in the
/// facet, those of one points in it.
struct FacetLoops {
  using Loop = std::span<const Index>;

  std::span<const Index> indices;
  std::span<const std::int64_t> loop_starts;  ///< into `indices`, and its length
  std::span<const std::int64_t> facet_starts; ///< into the loops, and their number

  [[nodiscard]] std::size_t size() const { return facet_starts.size() - 1; }
  [[nodiscard]] std::size_t n_loops(std::size_t facet) const {
    return static_cast<std::size_t>(facet_starts[facet + 1] - facet_starts[facet]);
  }
  [[nodiscard]] Loop loop(std::size_t facet, std::size_t k) const {
    const std::size_t at = static_cast<std::size_t>(facet_starts[facet]) + k;
    return indices.subspan(
        static_cast<std::size_t>(loop_starts[at]),
        static_cast<std::size_t>(loop_starts[at + 1] - loop_starts[at]));
  }
  [[nodiscard]] Loop outer(std::size_t facet) const { return loop(facet, 0); }
  /// The points of all loops of a facet.
  [[nodiscard]] Loop points(std::size_t facet) const {
    const auto start = loop_starts[static_cast<std::size_t>(facet_starts[facet])];
    const auto end = loop_starts[static_cast<std::size_t>(facet_starts[facet + 1])];
    return indices.subspan(static_cast<std::size_t>(start),
                           static_cast<std::size_t>(end - start));
  }
  /// A single loop of three points: what is planar and needs no triangulation.
  [[nodiscard]] bool is_triangle(std::size_t facet) const {
    return n_loops(facet) == 1 && outer(facet).size() == 3;
  }
};

} // namespace anistar::generate
