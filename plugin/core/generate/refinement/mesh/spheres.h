#pragma once
// Circumscribed and diametral spheres: what the rules measure, and the exact test that
// decides which cells a point takes away.

#include "base/predicates.h"

#include <algorithm>
#include <limits>

namespace anistar::generate {

/// Where p lies with respect to the circumscribed sphere of a positive tetrahedron.
[[nodiscard]] inline Side in_sphere(const Simplex<3> &s, const Vector<3> &p) {
  const double ax = s[0][0] - p[0], ay = s[0][1] - p[1], az = s[0][2] - p[2];
  const double bx = s[1][0] - p[0], by = s[1][1] - p[1], bz = s[1][2] - p[2];
  const double cx = s[2][0] - p[0], cy = s[2][1] - p[1], cz = s[2][2] - p[2];
  const double ex = s[3][0] - p[0], ey = s[3][1] - p[1], ez = s[3][2] - p[2];
  const double axby = ax * by, bxay = bx * ay, bxcy = bx * cy, cxby = cx * by;
  const double cxey = cx * ey, excy = ex * cy, exay = ex * ay, axey = ax * ey;
  const double axcy = ax * cy, cxay = cx * ay, bxey = bx * ey, exby = ex * by;
  const double ab = axby - bxay, bc = bxcy - cxby, ce = cxey - excy, ea = exay - axey;
  const double ac = axcy - cxay, be = bxey - exby;
  const double a2 = ax * ax + ay * ay + az * az, b2 = bx * bx + by * by + bz * bz;
  const double c2 = cx * cx + cy * cy + cz * cz, e2 = ex * ex + ey * ey + ez * ez;
  const double abc = az * bc - bz * ac + cz * ab, bce = bz * ce - cz * be + ez * bc;
  const double cea = cz * ea + ez * ac + az * ce, eab = ez * ab + az * be + bz * ea;
  const double det = (c2 * eab - e2 * abc) + (a2 * bce - b2 * cea);
  const double Az = std::abs(az), Bz = std::abs(bz), Cz = std::abs(cz),
               Ez = std::abs(ez);
  const double AB = std::abs(axby) + std::abs(bxay),
               BC = std::abs(bxcy) + std::abs(cxby);
  const double CE = std::abs(cxey) + std::abs(excy),
               EA = std::abs(exay) + std::abs(axey);
  const double AC = std::abs(axcy) + std::abs(cxay),
               BE = std::abs(bxey) + std::abs(exby);
  const double size =
      (CE * Bz + BE * Cz + BC * Ez) * a2 + (EA * Cz + AC * Ez + CE * Az) * b2 +
      (AB * Ez + BE * Az + EA * Bz) * c2 + (BC * Az + AC * Bz + AB * Cz) * e2;
  if (size > detail::underflow_guard) {
    const double bound = detail::sphere_bound_3 * size;
    if (det > bound)
      return Side::inside;
    if (det < -bound)
      return Side::outside;
  }
  constexpr SymmetricTensor<3> unit{{1, 0, 1, 0, 0, 1}};
  return detail::exact_in_sphere(unit, s[0], s[1], s[2], s[3], p);
}

/// A centre and a radius.
struct Ball {
  Vector<3> centre;
  double radius = std::numeric_limits<double>::infinity();
};

/// What is this near to a sphere is on it: right angles of the input, rounded, are no
/// reason to refine.
inline constexpr double on_sphere = 1e-10;

/// The smallest ball of a segment.
[[nodiscard]] inline Ball diametral_ball(const Vector<3> &a, const Vector<3> &b) {
  return {.5 * (a + b), .5 * (b - a).norm()};
}

/// The smallest ball whose sphere goes through the vertices of a triangle; infinite for
/// a flat one.
[[nodiscard]] inline Ball diametral_ball(const Vector<3> &a, const Vector<3> &b,
                                         const Vector<3> &c) {
  const Vector<3> u = b - a, v = c - a, n = u.cross(v);
  const double n2 = n.squaredNorm();
  if (!(n2 > 0))
    return {a};
  const Vector<3> offset =
      (n.cross(u) * v.squaredNorm() + v.cross(n) * u.squaredNorm()) / (2 * n2);
  return {a + offset, offset.norm()};
}

/// The circumscribed ball of a positive tetrahedron.
[[nodiscard]] inline Ball circumscribed_ball(const Simplex<3> &s) {
  const Vector<3> u = s[1] - s[0], v = s[2] - s[0], w = s[3] - s[0];
  const Vector<3> vw = v.cross(w);
  const double det = 2 * u.dot(vw);
  if (!(det > 0))
    return {s[0]};
  const Vector<3> offset = (vw * u.squaredNorm() + w.cross(u) * v.squaredNorm() +
                            u.cross(v) * w.squaredNorm()) /
                           det;
  return {s[0] + offset, offset.norm()};
}

/// Whether p is inside of the diametral ball, that is encroaches upon what it belongs
/// to.
[[nodiscard]] inline bool encroaches(const Vector<3> &p, const Ball &ball) {
  return (p - ball.centre).squaredNorm() < ball.radius * ball.radius * (1 - on_sphere);
}

/// The same for a segment, by the angle at p.
[[nodiscard]] inline bool encroaches(const Vector<3> &p, const Vector<3> &a,
                                     const Vector<3> &b) {
  const Vector<3> u = a - p, v = b - p;
  return u.dot(v) < -on_sphere * std::sqrt(u.squaredNorm() * v.squaredNorm());
}

/// Largest cosine of the dihedral angles of a tetrahedron: that of the least angle.
[[nodiscard]] inline double largest_dihedral_cosine(const Simplex<3> &s) {
  const Vector<3> u = s[1] - s[0], v = s[2] - s[0], w = s[3] - s[0];
  std::array<Vector<3>, 4> n{(v - u).cross(w - u), w.cross(v), u.cross(w), v.cross(u)};
  for (Vector<3> &normal : n)
    normal /= normal.norm();
  double largest = -1;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      largest = std::max(largest, -n[i].dot(n[j]));
  return largest;
}

} // namespace anistar::generate
