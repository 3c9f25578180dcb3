#pragma once
// Slabs of a volume mesh that threads change side by side.
//
// The vertices are cut into strips along an axis, equal in number, and two strips next
// to one another are a slab. What no slab contains, because it lies across the cut
// between two of them, is inside of a slab of the next round, which is shifted by one
// strip: so hardly anything is left to a single thread. Ranges of a Hilbert curve have
// far more surface, the more the thinner the cells are. The slabs depend on the mesh
// alone.

#include "mesh/triangulation.h"

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
  static constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();

  std::size_t n = 1; ///< in round 0
  std::vector<std::uint16_t> strip;
  /// Bit r: a cell at the vertex lies, or has lain, across a cut of round r.
  std::vector<std::uint8_t> border;

  [[nodiscard]] std::size_t count(int round) const { return n + round; }
  [[nodiscard]] Slab slab(std::size_t k, int round) const {
    return {2 * static_cast<int>(k) - round};
  }
  /// The slab with all cells at v, `nowhere` when there is none.
  [[nodiscard]] std::size_t of_star(Index v, int round) const {
    const bool is_border = (border[v] >> round & 1) != 0;
    return is_border ? nowhere : of_vertex(v, round);
  }
  /// The slab with the cell, `nowhere` when it lies across a cut or is free.
  [[nodiscard]] std::size_t of_cell(const Cell<3> &cell, int round) const;

  void add_vertex(Index v);
  /// Notes that there is a new cell. @pre it is not free
  void add_cell(const Cell<3> &cell) {
    const auto at = [&](std::size_t i) { return strip[cell[i]]; };
    if (at(0) != at(1) || at(0) != at(2) || at(0) != at(3))
      add_cell_on_strips(cell);
  }

private:
  [[nodiscard]] std::size_t of_vertex(Index v, int round) const {
    return (strip[v] + round) / 2;
  }
  void add_cell_on_strips(const Cell<3> &cell);
};

/// As many slabs as can be while the cells across their cuts are few; across the axis
/// where these are fewest. @pre the mesh was just renumbered
[[nodiscard]] Slabs cut_into_slabs(const Triangulation<3> &mesh);

} // namespace anistar
