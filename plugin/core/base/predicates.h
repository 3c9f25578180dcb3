#pragma once
// Exact geometric predicates on the stored doubles.
//
// A floating-point filter decides almost always; where its error bound does not
// separate the value from zero, exact arithmetic does (Shewchuk, Adaptive precision
// floating-point arithmetic, 1997, for the shape of the bounds). No filter decides on
// NaN, so that the exact arithmetic alone has to refuse it: std::domain_error.

#include "base/tensor.h"

namespace anistar {

enum class Orientation { negative = -1, degenerate = 0, positive = 1 };
enum class Side { outside = -1, boundary = 0, inside = 1 };

namespace detail {
/// Unit round-off of a double.
inline constexpr double round_off = 0x1p-53;
/// Relative error bounds of the filters below: the number of roundings that a term
/// goes through, rounded up.
inline constexpr double orientation_bound_2 = 4 * round_off;
inline constexpr double orientation_bound_3 = 8 * round_off;
inline constexpr double sphere_bound_2 = 16 * round_off;
inline constexpr double sphere_bound_3 = 32 * round_off;
/// Determinants of edge vectors are off by a few round-offs of the product of their
/// lengths; this is twice what a validator in double precision asks of a cell.
inline constexpr double flatness = 64 * round_off;
/// Below this magnitude products may have lost bits to underflow.
inline constexpr double underflow_guard = 1e-200;

[[nodiscard]] Orientation exact_orientation(const Vector<2> &a, const Vector<2> &b,
                                            const Vector<2> &c);
[[nodiscard]] Orientation exact_orientation(const Vector<3> &a, const Vector<3> &b,
                                            const Vector<3> &c, const Vector<3> &e);
[[nodiscard]] Side exact_in_sphere(const SymmetricTensor<2> &M, const Vector<2> &a,
                                   const Vector<2> &b, const Vector<2> &c,
                                   const Vector<2> &p);
[[nodiscard]] Side exact_in_sphere(const SymmetricTensor<3> &M, const Vector<3> &a,
                                   const Vector<3> &b, const Vector<3> &c,
                                   const Vector<3> &e, const Vector<3> &p);
} // namespace detail

/// Twice the signed area of abc, rounded.
[[nodiscard]] inline double cross(const Vector<2> &u, const Vector<2> &v) {
  return u[0] * v[1] - u[1] * v[0];
}

/// Positive when a, b, c turn left.
[[nodiscard]] inline Orientation orientation(const Vector<2> &a, const Vector<2> &b,
                                             const Vector<2> &c) {
  const double left = (a[0] - c[0]) * (b[1] - c[1]);
  const double right = (a[1] - c[1]) * (b[0] - c[0]);
  const double det = left - right;
  const double size = std::abs(left) + std::abs(right);
  if (size > detail::underflow_guard) {
    const double bound = detail::orientation_bound_2 * size;
    if (det > bound)
      return Orientation::positive;
    if (det < -bound)
      return Orientation::negative;
  }
  return detail::exact_orientation(a, b, c);
}

/// Positive when e is on the side of abc from which a, b, c appear clockwise, that is
/// when det [b-a, c-a, e-a] > 0: the sign of the volume.
[[nodiscard]] inline Orientation orientation(const Vector<3> &a, const Vector<3> &b,
                                             const Vector<3> &c, const Vector<3> &e) {
  const Vector<3> u = b - a, v = c - a, w = e - a;
  const double xy = u[0] * v[1], yx = u[1] * v[0], yz = u[1] * v[2], zy = u[2] * v[1];
  const double zx = u[2] * v[0], xz = u[0] * v[2];
  const double det = (xy - yx) * w[2] + (yz - zy) * w[0] + (zx - xz) * w[1];
  const double size = (std::abs(xy) + std::abs(yx)) * std::abs(w[2]) +
                      (std::abs(yz) + std::abs(zy)) * std::abs(w[0]) +
                      (std::abs(zx) + std::abs(xz)) * std::abs(w[1]);
  if (size > detail::underflow_guard) {
    const double bound = detail::orientation_bound_3 * size;
    if (det > bound)
      return Orientation::positive;
    if (det < -bound)
      return Orientation::negative;
  }
  return detail::exact_orientation(a, b, c, e);
}

template <std::size_t d> using Simplex = std::array<Vector<d>, d + 1>;

template <std::size_t d> [[nodiscard]] Orientation orientation(const Simplex<d> &s) {
  if constexpr (d == 2)
    return orientation(s[0], s[1], s[2]);
  else
    return orientation(s[0], s[1], s[2], s[3]);
}

/// d! times the signed volume, rounded.
template <std::size_t d>
[[nodiscard]] inline double volume_determinant(const Simplex<d> &s) {
  if constexpr (d == 2)
    return cross(s[1] - s[0], s[2] - s[0]);
  else
    return (s[1] - s[0]).dot((s[2] - s[0]).cross(s[3] - s[0]));
}

/// Whether the volume of a simplex is positive and above the round-off of its edges,
/// whatever the order of its vertices: a cell of less, positive as it may be exactly,
/// is flat to everyone who computes with doubles.
template <std::size_t d> [[nodiscard]] inline bool has_volume(const Simplex<d> &s) {
  double longest = 0; // squared
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = i + 1; j <= d; ++j)
      longest = std::max(longest, (s[j] - s[i]).squaredNorm());
  const double bound = detail::flatness * longest;
  return volume_determinant<d>(s) > (d == 2 ? bound : bound * std::sqrt(longest));
}

/// A value with the sum of the magnitudes of its terms, to which its error is relative.
struct Estimate {
  double value, size;
};

/// det [x_i - p | (x_i - p)^T M (x_i - p)] for x = a, b, c, rounded.
[[nodiscard]] inline Estimate sphere_determinant(const SymmetricTensor<2> &M,
                                                 const Vector<2> &a, const Vector<2> &b,
                                                 const Vector<2> &c,
                                                 const Vector<2> &p) {
  const Vector<2> u = a - p, v = b - p, w = c - p;
  const double u0v1 = u[0] * v[1], u1v0 = u[1] * v[0], v0w1 = v[0] * w[1],
               v1w0 = v[1] * w[0], w0u1 = w[0] * u[1], w1u0 = w[1] * u[0];
  const double xx = M.entries[0], xy = 2 * M.entries[1], yy = M.entries[2];
  const auto square = [&](const Vector<2> &x) {
    return xx * x[0] * x[0] + xy * x[0] * x[1] + yy * x[1] * x[1];
  };
  const auto bound_of = [&](const Vector<2> &x) {
    return xx * x[0] * x[0] + std::abs(xy * x[0] * x[1]) + yy * x[1] * x[1];
  };
  return {(v0w1 - v1w0) * square(u) + (w0u1 - w1u0) * square(v) +
              (u0v1 - u1v0) * square(w),
          (std::abs(v0w1) + std::abs(v1w0)) * bound_of(u) +
              (std::abs(w0u1) + std::abs(w1u0)) * bound_of(v) +
              (std::abs(u0v1) + std::abs(u1v0)) * bound_of(w)};
}

/// Where p lies with respect to the circumscribed ellipse of abc in the metric M: the
/// sign of det [x_i - p | (x_i - p)^T M (x_i - p)], which is linear in M.
/// @pre a, b, c turn left.
[[nodiscard]] inline Side in_metric_sphere(const SymmetricTensor<2> &M,
                                           const Vector<2> &a, const Vector<2> &b,
                                           const Vector<2> &c, const Vector<2> &p) {
  const Estimate det = sphere_determinant(M, a, b, c, p);
  if (det.size > detail::underflow_guard) {
    const double bound = detail::sphere_bound_2 * det.size;
    if (det.value > bound)
      return Side::inside;
    if (det.value < -bound)
      return Side::outside;
  }
  return detail::exact_in_sphere(M, a, b, c, p);
}

/// The same in 3D. @pre abce has positive volume.
[[nodiscard]] Side in_metric_sphere(const SymmetricTensor<3> &M, const Vector<3> &a,
                                    const Vector<3> &b, const Vector<3> &c,
                                    const Vector<3> &e, const Vector<3> &p);

template <std::size_t d>
[[nodiscard]] Side in_metric_sphere(const SymmetricTensor<d> &M, const Simplex<d> &s,
                                    const Vector<d> &p) {
  if constexpr (d == 2)
    return in_metric_sphere(M, s[0], s[1], s[2], p);
  else
    return in_metric_sphere(M, s[0], s[1], s[2], s[3], p);
}

} // namespace anistar
