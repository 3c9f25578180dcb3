#pragma once
// The cells around an edge, and what the edge lies on.

#include "volume/mesh/volume.h"

namespace anistar {

/// The cells around an edge in order; cell k has ring[k] and ring[k+1].
struct Shell {
  static constexpr std::size_t capacity = 64;
  Index a = none, b = none;
  std::size_t n_cells = 0;
  bool is_closed = false; ///< else ring has one vertex more than there are cells
  std::array<Index, capacity> cells;
  std::array<Index, capacity + 1> ring;

  [[nodiscard]] std::size_t n_ring() const { return n_cells + (is_closed ? 0 : 1); }
  [[nodiscard]] std::span<const Index> all() const { return {cells.data(), n_cells}; }
};

/// @returns false when it has too many cells.
[[nodiscard]] bool shell_of(const Triangulation<3> &mesh, Index cell, Index a, Index b,
                            Shell &shell);

/// The constrained facets at an edge, as positions in the ring of its shell and
/// patches; only the first four are kept, but all are counted.
struct EdgeWalls {
  std::size_t n = 0;
  std::array<std::size_t, 4> position{};
  std::array<Index, 4> patch{};

  /// Whether cells around vertex k of the ring may replace those around the edge: new
  /// facets of a surface meet there.
  [[nodiscard]] bool admits_apex(std::size_t k) const {
    return n != 2 || k == position[0] || k == position[1];
  }
};
[[nodiscard]] EdgeWalls walls_at(const Volume &volume, const Shell &shell);
/// The walls of an edge that may be removed: it is no ridge, it has none or two of one
/// patch, and its ring is no longer than that. @param shell becomes that of the edge
[[nodiscard]] std::optional<EdgeWalls> walls_of_removable(const Volume &volume,
                                                          Index cell, Index a, Index b,
                                                          std::size_t longest_ring,
                                                          Shell &shell);

/// An edge of the mesh as a place for a new vertex.
struct EdgeFeature {
  Index dimension = 3, lies_on = none; ///< of its inner points
  Index ridge = none;                  ///< entry of the ridge graph
  bool is_frozen = false;
};
[[nodiscard]] EdgeFeature feature_of(const Volume &volume, const Shell &shell);

} // namespace anistar
