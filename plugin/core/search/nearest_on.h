#pragma once
// Nearest points of segments and triangles.

#include "base/tensor.h"

#include <algorithm>
#include <limits>

namespace anistar {

/// Barycentric coordinates of the point of segment ab nearest to x.
inline std::array<double, 2> nearest_on(const Vector<2> &x,
                                        const std::array<Vector<2>, 2> &segment) {
  const Vector<2> u = segment[1] - segment[0];
  const double t =
      std::clamp((x - segment[0]).dot(u) / std::max(u.squaredNorm(), 1e-300), 0., 1.);
  return {1 - t, t};
}

/// The same for a triangle: the foot on its plane when that lies inside, else the
/// nearest point of the sides. In an orthogonal frame, so that thin triangles lose as
/// few digits as their aspect ratio has.
inline std::array<double, 3> nearest_on(const Vector<3> &x,
                                        const std::array<Vector<3>, 3> &triangle) {
  const Vector<3> ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0],
                  ax = x - triangle[0];
  const double along = std::max(ab.squaredNorm(), 1e-300);
  const double slant = ac.dot(ab) / along;
  const Vector<3> across = ac - slant * ab;
  const double c = ax.dot(across) / std::max(across.squaredNorm(), 1e-300);
  const double b = ax.dot(ab) / along - c * slant;
  if (b >= 0 && c >= 0 && b + c <= 1)
    return {1 - b - c, b, c};
  std::array<double, 3> best{};
  double best_distance = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = k, j = (k + 1) % 3;
    const Vector<3> u = triangle[j] - triangle[i];
    const double t = std::clamp(
        (x - triangle[i]).dot(u) / std::max(u.squaredNorm(), 1e-300), 0., 1.);
    const double distance = (x - triangle[i] - t * u).squaredNorm();
    if (distance < best_distance) {
      best_distance = distance;
      best = {};
      best[i] = 1 - t;
      best[j] = t;
    }
  }
  return best;
}

} // namespace anistar
