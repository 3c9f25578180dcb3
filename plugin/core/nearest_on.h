#pragma once
// Nearest points of segments and triangles.

#include "tensor.h"

namespace anistar {

/// Barycentric coordinates of the point of segment ab nearest to x.
[[nodiscard]] inline std::array<double, 2>
nearest_on(const Vector<2> &x, const std::array<Vector<2>, 2> &segment) {
  const Vector<2> u = segment[1] - segment[0];
  const double t =
      std::clamp((x - segment[0]).dot(u) / std::max(u.squaredNorm(), 1e-300), 0., 1.);
  return {1 - t, t};
}

/// The same for a triangle, by the regions of the plane around it (Ericson, Real-Time
/// Collision Detection, 2005, section 5.1.5).
[[nodiscard]] inline std::array<double, 3>
nearest_on(const Vector<3> &x, const std::array<Vector<3>, 3> &triangle) {
  const auto &[a, b, c] = triangle;
  const Vector<3> ab = b - a, ac = c - a, ax = x - a, bx = x - b, cx = x - c;
  const double d1 = ab.dot(ax), d2 = ac.dot(ax);
  if (d1 <= 0 && d2 <= 0)
    return {1, 0, 0};
  const double d3 = ab.dot(bx), d4 = ac.dot(bx);
  if (d3 >= 0 && d4 <= d3)
    return {0, 1, 0};
  const double d5 = ab.dot(cx), d6 = ac.dot(cx);
  if (d6 >= 0 && d5 <= d6)
    return {0, 0, 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0)
    return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0)
    return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - t, t};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

} // namespace anistar
