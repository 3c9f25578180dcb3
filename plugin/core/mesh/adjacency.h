#pragma once
// Cells and how they meet.

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace anistar {

using Index = std::int32_t;
inline constexpr Index none = -1;

/// An entry for every vertex, or for every cell: what an Index selects from.
template <class T> using PerVertex = std::vector<T>;
template <class T> using PerCell = std::vector<T>;

/// The d + 1 vertices of a simplex, positively oriented. Facet i lies opposite vertex
/// i.
template <std::size_t d> using Cell = std::array<Index, d + 1>;
template <std::size_t d> using Facet = std::array<Index, d>;

/// The vertices of facet i, oriented so that the cell is on its positive side:
/// orientation(facet..., opposite vertex) > 0.
template <std::size_t d>
[[nodiscard]] constexpr Facet<d> facet_of(const Cell<d> &cell, std::size_t i) {
  if constexpr (d == 2) {
    return {cell[(i + 1) % 3], cell[(i + 2) % 3]};
  } else {
    constexpr std::size_t order[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
    return {cell[order[i][0]], cell[order[i][1]], cell[order[i][2]]};
  }
}

/// A facet seen from one of its two cells, in one word: four facets a cell.
class HalfFacet {
public:
  constexpr HalfFacet() = default;
  constexpr HalfFacet(Index cell, std::size_t facet)
      : code_(cell * 4 + static_cast<Index>(facet)) {}

  /// `none` for the far side of a boundary facet.
  [[nodiscard]] constexpr Index cell() const { return code_ >> 2; }
  [[nodiscard]] constexpr std::size_t facet() const {
    return static_cast<std::size_t>(code_ & 3);
  }
  [[nodiscard]] constexpr bool exists() const { return code_ >= 0; }
  /// As one number.
  [[nodiscard]] constexpr Index code() const { return code_; }
  /// In the order of the cells.
  friend auto operator<=>(const HalfFacet &, const HalfFacet &) = default;

private:
  Index code_ = none;
};

template <std::size_t d> using Neighbours = std::array<HalfFacet, d + 1>;

/// For every cell and facet the half-facet on the other side, which does not exist
/// at the boundary. @throws std::invalid_argument when three cells share a facet.
template <std::size_t d>
[[nodiscard]] std::vector<Neighbours<d>> adjacency(std::span<const Cell<d>> cells,
                                                   std::size_t n_points);

/// The edges of the cells, each once, as pairs of indices in increasing order.
template <std::size_t d>
[[nodiscard]] std::vector<std::array<Index, 2>> edges_of(std::span<const Cell<d>> cells,
                                                         std::size_t n_points);

} // namespace anistar
