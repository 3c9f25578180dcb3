#pragma once
// What a complex is made of, each by itself: triangles, and segments and points that
// are part of none.

#include "mesh/adjacency.h"

#include <array>
#include <optional>
#include <span>

namespace anistar::generate {

/// The simplex of one to three points. Points of equal coordinates go by one number.
struct Piece {
  std::array<Index, 3> corners;
  std::size_t n_corners;

  [[nodiscard]] std::span<const Index> points() const {
    return {corners.data(), n_corners};
  }
  [[nodiscard]] bool has(Index v) const {
    for (const Index w : points())
      if (v == w)
        return true;
    return false;
  }
  [[nodiscard]] bool is_triangle() const { return n_corners == 3; }
  [[nodiscard]] bool is_segment() const { return n_corners == 2; }
  [[nodiscard]] std::size_t n_edges() const {
    return is_triangle() ? 3 : n_corners - 1;
  }
  [[nodiscard]] std::array<Index, 2> edge(std::size_t k) const {
    return {corners[k], corners[(k + 1) % n_corners]};
  }
};

[[nodiscard]] inline std::size_t n_shared(const Piece &a, const Piece &b) {
  std::size_t count = 0;
  for (const Index v : a.points())
    count += b.has(v) ? 1 : 0;
  return count;
}

} // namespace anistar::generate
