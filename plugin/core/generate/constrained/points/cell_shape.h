#pragma once
// How flat a cell or a triangle is, in rounded coordinates.

#include "generate/constrained/points/exact_points.h"

#include <algorithm>

namespace anistar::generate {

/// Six times the volume of a cell, over the cube of its longest edge: sqrt(1/2) for the
/// regular tetrahedron.
[[nodiscard]] inline double shape_of(const ExactPoints &points, const Cell<3> &cell) {
  Simplex<3> x;
  for (std::size_t i = 0; i < 4; ++i)
    x[i] = points.rounded(cell[i]);
  double longest = 0; // squared
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      longest = std::max(longest, (x[j] - x[i]).squaredNorm());
  return volume_determinant<3>(x) / (longest * std::sqrt(longest));
}

/// Twice the area of a triangle, over the square of its longest edge.
[[nodiscard]] inline double shape_of(const ExactPoints &points, Index a, Index b,
                                     Index c) {
  const Vector<3> u = points.rounded(b) - points.rounded(a),
                  v = points.rounded(c) - points.rounded(a);
  const double longest =
      std::max({u.squaredNorm(), v.squaredNorm(), (v - u).squaredNorm()});
  return u.cross(v).norm() / longest;
}

} // namespace anistar::generate
