#pragma once
// Slabs of a volume mesh that threads change side by side.
//
// The vertices are cut into strips along an axis, equal in number, and two strips next
// to one another are a slab. What no slab contains, because it lies across the cut
// between two of them, is inside of a slab of the next round, which is shifted by one
// strip: so hardly anything is left to a single thread. Ranges of a Hilbert curve have
// far more surface, the more the thinner the cells are. The slabs depend on the mesh
// alone.

#include "triangulation.h"

#include <cstdint>

namespace anistar {

/// Two strips.
struct Slab {
  int first;

  [[nodiscard]] bool contains(std::uint16_t strip) const {
    return static_cast<unsigned>(static_cast<int>(strip) - first) < 2;
  }
};

/// The strip of every vertex. In round 0 slab k has the strips 2 k and 2 k + 1, in
/// round 1 one less.
struct Slabs {
  static constexpr int n_rounds = 2;
  static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

  std::size_t n = 1; ///< in round 0
  std::vector<std::uint16_t> strip;

  [[nodiscard]] std::size_t count(int round) const {
    return n + static_cast<std::size_t>(round);
  }
  [[nodiscard]] Slab slab(std::size_t k, int round) const {
    return {2 * static_cast<int>(k) - round};
  }
  [[nodiscard]] std::size_t of_vertex(Index v, int round) const {
    return (strip[static_cast<std::size_t>(v)] + static_cast<std::size_t>(round)) / 2;
  }
  /// `nowhere` when the cell lies across a cut, or is free.
  [[nodiscard]] std::size_t of_cell(const Cell<3> &cell, int round) const;
};

/// As many slabs as can be while the cells across their cuts are few.
[[nodiscard]] Slabs cut_into_slabs(const Triangulation<3> &mesh);

} // namespace anistar
