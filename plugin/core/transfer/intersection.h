#pragma once
// The intersection of two simplices, as the moments that a projection needs.

#include "base/predicates.h"
#include "base/tensor.h"
#include "mesh/adjacency.h"

#include <array>

namespace anistar {

/// Integrals of products of barycentric coordinates, those of the target cell times
/// those of the source cell.
template <std::size_t d> using Moments = std::array<std::array<double, d + 1>, d + 1>;

/// Sums of the moments over the source's index: integrals of the target's coordinates.
template <std::size_t d>
[[nodiscard]] inline std::array<double, d + 1> row_sums(const Moments<d> &moments) {
  std::array<double, d + 1> sums{};
  for (std::size_t i = 0; i <= d; ++i)
    for (std::size_t j = 0; j <= d; ++j)
      sums[i] += moments[i][j];
  return sums;
}

/// Row j, column k: barycentric coordinate j in the source cell of corner k of the
/// target cell. Corners within the round-off of a facet's plane lie on it, so that
/// shared vertices and facets are shared exactly.
template <std::size_t d> using Sides = std::array<std::array<double, d + 1>, d + 1>;

template <std::size_t d>
[[nodiscard]] Sides<d> sides(const Simplex<d> &target, const Simplex<d> &source);

/// Moments over the intersection, zero when it has no volume. The target cell is cut by
/// the planes of the source's facets one after the other, in barycentric coordinates,
/// where nothing depends on the shape or the place of the cell; every piece is split
/// into simplices on which the moments are exact.
///
/// @param at what `sides` returns for the two cells.
/// @param volume that of the target cell.
template <std::size_t d>
[[nodiscard]] Moments<d> intersection_moments(const Sides<d> &at, double volume);

} // namespace anistar
