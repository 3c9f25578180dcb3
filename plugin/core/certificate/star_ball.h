#pragma once
// The balls of a star in rounded arithmetic, in coordinates where they are round.
//
// All cells of the star of v are judged by the metric M of v, and their balls pass
// through v. With y the offset from v and M = L L^T, the coordinates are z = L^T y, and
// the power of a point in the ball of a cell is
//     |z|^2 - g.z,   g = sum_k |a_k|^2 n_k / det,
// where a_k are the other corners of the cell and n_k is the vector with n_k.a_k = det
// and n_k.a_i = 0. The first term is the same for all balls.
//
// Errors. Let u be the round-off and S^2 = d sum_i M_ii y_i^2, so that
// |y|^T |L| |L|^T |y| <= S^2 by the inequality of Cauchy and Schwarz. The factor that
// is computed satisfies |M - L L^T| <= (d + 1) u |L| |L|^T (Higham, Accuracy and
// Stability of Numerical Algorithms, theorem 10.3). Let z be the exact image of y by
// this factor.
// - What is computed for z is off by at most 4.1 u S: d + 1 roundings in every term.
// - |z|^2, as the value of y^T M y: 4.1 u S^2 for M, 8.2 u S^2 for z, 3.1 u S^2 for the
//   sum; 15.4 u S^2 together. The offset of two points p, q has S <= S_p + S_q, and its
//   square is off by at most 18.4 u (S_p + S_q)^2.
// - A cross product is off by at most |a| db + |b| da and 2.9 u |a| |b| for its own
//   roundings, where da, db are the errors of its arguments; its product with a vector
//   likewise.
// - g: the numerator N and the determinant by the same rules, and
//   |N / det - g'| <= (dN + |g'| ddet) / (det - ddet) for the rounded quotient g'.
// Each bound below is at least 1.5 times the sum of what goes into it, which covers the
// products of errors and the rounding of the bounds. What cannot be bounded is
// infinite or NaN, and decides nothing.

#include "base/bounded.h"
#include "base/predicates.h"
#include "mesh/measures.h"

#include <array>
#include <limits>

namespace anistar {

/// A point as a star sees it.
template <std::size_t d> struct StarPoint {
  Vector<d> z;     ///< in the coordinates of the metric, from the vertex of the star
  double length;   ///< not less than that of z, exact or rounded
  double size;     ///< S
  double z_error;  ///< bounds the length of the error of z
  double square;   ///< |z|^2
  double sq_error; ///< of the square
};

namespace detail {
/// In units of S and of S^2.
inline constexpr double z_error_bound = 16 * round_off;
inline constexpr double square_error_bound = 32 * round_off;
} // namespace detail

/// The coordinates of a star.
template <std::size_t d> class StarFrame {
public:
  StarFrame() = default;
  explicit StarFrame(const Vertex<d> &v) : origin_(v.x), L_(lower_factor<d>(v.M)) {
    for (std::size_t i = 0; i < d; ++i)
      diagonal_[static_cast<int>(i)] = double(d) * v.M(i, i);
  }

  [[nodiscard]] StarPoint<d> point(const Vector<d> &x) const {
    constexpr int n = static_cast<int>(d);
    const Vector<d> y = x - origin_;
    StarPoint<d> p;
    for (int i = 0; i < n; ++i) {
      double sum = L_(i, i) * y[i];
      for (int k = i + 1; k < n; ++k)
        sum += L_(k, i) * y[k];
      p.z[i] = sum;
    }
    const double S2 = diagonal_.dot(y.cwiseProduct(y));
    p.square = p.z.squaredNorm();
    p.size = std::sqrt(S2);
    p.z_error = detail::z_error_bound * p.size;
    p.sq_error = detail::square_error_bound * S2;
    p.length = std::sqrt(p.square) + p.z_error;
    return p;
  }

private:
  Vector<d> origin_, diagonal_;
  Matrix<d> L_;
};

/// The squared distance of two points.
template <std::size_t d>
[[nodiscard]] Bounded square_between(const StarPoint<d> &p, const StarPoint<d> &q) {
  const double size = p.size + q.size;
  return {(p.z - q.z).squaredNorm(), detail::square_error_bound * size * size};
}

/// The ball of a cell of the star: the power of a point is that of the point as a
/// square less its product with the gradient.
template <std::size_t d> struct StarBall {
  Vector<d> gradient;
  double length, error; ///< of the gradient

  [[nodiscard]] Bounded power(const StarPoint<d> &p) const {
    return {p.square - gradient.dot(p.z),
            p.sq_error + error * p.length + length * p.z_error + Bounded::underflow};
  }
};

/// @param a the corners of a cell apart from v, positively oriented
template <std::size_t d>
[[nodiscard]] StarBall<d> star_ball(const std::array<const StarPoint<d> *, d> &a) {
  std::array<Vector<d>, d> normals;
  std::array<double, d> lengths, errors; // bounds of both
  for (std::size_t k = 0; k < d; ++k) {
    const StarPoint<d> &p = *a[(k + 1) % d];
    if constexpr (d == 2) {
      normals[k] = k == 0 ? Vector<2>(p.z[1], -p.z[0]) : Vector<2>(-p.z[1], p.z[0]);
      lengths[k] = p.length;
      errors[k] = p.z_error;
    } else {
      const StarPoint<d> &q = *a[(k + 2) % d];
      normals[k] = p.z.cross(q.z);
      lengths[k] = p.length * q.length;
      errors[k] = p.length * q.z_error + q.length * p.z_error;
    }
  }
  Vector<d> sum = Vector<d>::Zero();
  double sum_error = 0;
  for (std::size_t k = 0; k < d; ++k) {
    sum += a[k]->square * normals[k];
    sum_error += a[k]->sq_error * lengths[k] + a[k]->square * errors[k];
  }
  const double det = normals[0].dot(a[0]->z);
  const double det_error = errors[0] * a[0]->length + lengths[0] * a[0]->z_error;
  const double least = det - det_error;
  StarBall<d> ball{sum / det, 0, std::numeric_limits<double>::infinity()};
  ball.length = ball.gradient.norm();
  const double rest = det_error + 4 * detail::round_off * det;
  if (least > detail::underflow_guard)
    ball.error = (sum_error + ball.length * rest) / least;
  return ball;
}

} // namespace anistar
