#pragma once
// The power of a weighted point in the ball of a cell of a star, exactly.

#include "base/predicates.h"
#include "mesh/adjacency.h"

namespace anistar {

struct WeightedPoint {
  Vector<3> x;
  double weight;
  Index rank; ///< decides ties: no two of one test are equal
};

/// The vertex of a star, the three others of one of its cells, and the point in doubt.
using PowerTest = std::array<WeightedPoint, 5>;

/// Whether the last point lies in the ball of the cell of the first four in metric M:
/// the ball orthogonal to theirs. There are no ties: the point of highest rank counts
/// as lifted by more than all of lower rank together, so that stars with one metric
/// are those of one triangulation, which has no flat cell.
/// @pre the cell is positively oriented
[[nodiscard]] Side exact_power_side(const SymmetricTensor<3> &M, const PowerTest &test);

/// The centre of the ball orthogonal to those of the corners of a cell, to the last
/// digits even where it is nearly flat. The first corner is that of the star.
[[nodiscard]] Vector<3> exact_centre(const SymmetricTensor<3> &M,
                                     const std::array<WeightedPoint, 4> &cell);

} // namespace anistar
