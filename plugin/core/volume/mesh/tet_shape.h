#pragma once
// The shape of tetrahedra in the mean of the metrics of their corners.
//
// Reports take the metric of the densest corner (mesh/measures.h). The mean varies
// smoothly when a vertex moves, which is what an optimiser needs, and costs one
// determinant.

#include "base/predicates.h"
#include "mesh/measures.h"

#include <bit>
#include <cstdint>

namespace anistar {

/// Sum of the four metrics at the corners of a cell.
[[nodiscard]] inline SymmetricTensor<3> metric_sum(const SymmetricTensor<3> &a,
                                                   const SymmetricTensor<3> &b,
                                                   const SymmetricTensor<3> &c) {
  SymmetricTensor<3> sum;
  for (std::size_t k = 0; k < 6; ++k)
    sum.entries[k] = a.entries[k] + b.entries[k] + c.entries[k];
  return sum;
}

namespace detail {
/// The square of `flatness`, against squared volumes.
inline constexpr double squared_flatness = flatness * flatness;

/// Cube root of 0 <= x <= 1 to single precision: a guess from the exponent, then two
/// Newton steps.
[[nodiscard]] inline float cube_root(float x) {
  float y = std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) / 3 + 709921077u);
  y -= (y * y * y - x) / (3 * y * y);
  y -= (y * y * y - x) / (3 * y * y);
  return y;
}
} // namespace detail

/// The cube of the mean ratio of the cell with edges e, f, g at a corner, in a quarter
/// of the metric m; not positive when det [e, f, g] is below round-off.
///
/// A positive value proves that the exact determinant is positive, so no exact
/// arithmetic is needed behind it. With u the unit round-off and S the sum of the six
/// squared edges:
/// - Every term of v goes through 8 roundings, the differences of coordinates included,
///   so v is off by 8.01 u times the permanent of |e|, |f|, |g|. That is at most the
///   product of their 1-norms, 3 sqrt 3 |e| |f| |g|, which is at most S^1.5 because
///   |e|^2 + |f|^2 + |g|^2 <= S.
/// - `plain` is S within 64 u: by Cauchy's inequality 4 (ee + ff + gg) - ss is at
///   least a quarter of what it is computed from.
/// - So v > 64 u S^1.5, but for those errors and a few u, leaves more than 55 u S^1.5.
/// - Underflow: v v > 0 needs v > 2^-538, while products that underflow change v by
///   less than 2^-1070 times an edge; a bound that underflows is below 2^-537.
/// - Overflow of the bound or of both gives no positive difference.
/// Cells between that bound and zero are refused: they are flat to whoever computes
/// with doubles.
[[nodiscard]] inline double cubed_shape(const double ex, const double ey,
                                        const double ez, const double fx,
                                        const double fy, const double fz,
                                        const double gx, const double gy,
                                        const double gz, const double *m) {
  const double v =
      ex * (fy * gz - fz * gy) + ey * (fz * gx - fx * gz) + ez * (fx * gy - fy * gx);
  // the six edges' outer products add up to 4 (ee + ff + gg) - ss, s = e + f + g
  const double sx = ex + fx + gx, sy = ey + fy + gy, sz = ez + fz + gz;
  const double xx = 4 * (ex * ex + fx * fx + gx * gx) - sx * sx;
  const double xy = 4 * (ex * ey + fx * fy + gx * gy) - sx * sy;
  const double yy = 4 * (ey * ey + fy * fy + gy * gy) - sy * sy;
  const double xz = 4 * (ex * ez + fx * fz + gx * gz) - sx * sz;
  const double yz = 4 * (ey * ez + fy * fz + gy * gz) - sy * sz;
  const double zz = 4 * (ez * ez + fz * fz + gz * gz) - sz * sz;
  const double squares =
      m[0] * xx + m[2] * yy + m[5] * zz + 2 * (m[1] * xy + m[3] * xz + m[4] * yz);
  const double det_m0 = detail::definite_determinant_times_first(m);
  const double plain = xx + yy + zz; // bounds the square of the longest edge
  const double vv = v * v;
  // 432 makes a regular tetrahedron 1; factored so that nothing over- or underflows
  const double shape = 432 * (vv / squares) * (det_m0 / (m[0] * squares)) / squares;
  const double solid = vv - detail::squared_flatness * plain * plain * plain;
  return v > 0 && solid > 0 ? shape : -1;
}

/// The mean ratio to single precision; -1 when its cube is not positive. There is no
/// branch, for loops over many cells.
[[nodiscard]] inline float mean_ratio(double cubed) {
  const float root = detail::cube_root(static_cast<float>(std::max(cubed, 1e-30)));
  return cubed > 0 ? root : -1.f;
}

/// Mean ratio of the cell abcd; -1 when it is flat or inverted.
[[nodiscard]] inline double shape_quality(const Vertex<3> &a, const Vertex<3> &b,
                                          const Vertex<3> &c, const Vertex<3> &d) {
  const Vector<3> e = b.x - a.x, f = c.x - a.x, g = d.x - a.x;
  SymmetricTensor<3> m = metric_sum(a.M, b.M, c.M);
  m += d.M;
  return static_cast<double>(mean_ratio(cubed_shape(
      e[0], e[1], e[2], f[0], f[1], f[2], g[0], g[1], g[2], m.entries.data())));
}

/// Six times the volume.
[[nodiscard]] inline double volume6(const Vector<3> &a, const Vector<3> &b,
                                    const Vector<3> &c, const Vector<3> &d) {
  return (b - a).dot((c - a).cross(d - a));
}

/// Close to mean_length, without a logarithm.
[[nodiscard]] inline double fast_length(const Vertex<3> &a, const Vertex<3> &b) {
  const Vector<3> e = b.x - a.x;
  const double la = std::sqrt(quadratic<3>(a.M, e)),
               lb = std::sqrt(quadratic<3>(b.M, e));
  return (2 * std::sqrt(la * lb) + .5 * (la + lb)) / 3;
}

/// Which of many cells have one point in their circumballs in one metric, beyond
/// round-off. The determinant is linear in the metric. It proposes, and decides
/// nothing.
class BallTests {
public:
  static constexpr std::size_t capacity = 128;

  void clear() { n_ = 0; }
  [[nodiscard]] std::size_t size() const { return n_; }
  /// @pre abcd is positive, and there are less than `capacity`.
  void add(const Vector<3> &a, const Vector<3> &b, const Vector<3> &c,
           const Vector<3> &d, const Vector<3> &p) {
    for (int k = 0; k < 3; ++k) {
      a_[k][n_] = a[k] - p[k];
      b_[k][n_] = b[k] - p[k];
      c_[k][n_] = c[k] - p[k];
      d_[k][n_] = d[k] - p[k];
    }
    ++n_;
  }
  void evaluate(const SymmetricTensor<3> &M);
  [[nodiscard]] bool is_in_ball(std::size_t k) const { return excess_[k] > 0; }

private:
  std::size_t n_ = 0;
  double a_[3][capacity], b_[3][capacity], c_[3][capacity], d_[3][capacity];
  double excess_[capacity];
};

/// The cells around one vertex, laid out for many trial positions of it.
class StarShapes {
public:
  static constexpr std::size_t capacity = 128;

  void clear() { n_ = 0; }
  [[nodiscard]] std::size_t size() const { return n_; }
  /// @pre (a, b, c, vertex) is positive.
  void add(const Vertex<3> &a, const Vertex<3> &b, const Vertex<3> &c) {
    for (int k = 0; k < 3; ++k) {
      a_[k][n_] = a.x[k];
      b_[k][n_] = c.x[k]; // seen from the vertex the order turns
      c_[k][n_] = b.x[k];
    }
    const SymmetricTensor<3> m = metric_sum(a.M, b.M, c.M);
    for (std::size_t k = 0; k < 6; ++k)
      m_[k][n_] = m.entries[k];
    ++n_;
  }
  /// Whether all cells are positive, up to round-off, with the vertex at x: elsewhere
  /// it needs no metric. Not where x is not finite.
  [[nodiscard]] bool are_positive(const Vector<3> &x) const;
  /// Qualities with the vertex at x.
  void evaluate(const Vertex<3> &x);
  [[nodiscard]] double minimum() const { return minimum_; }
  [[nodiscard]] double sum() const { return sum_; }
  [[nodiscard]] float quality(std::size_t k) const { return quality_[k]; }

private:
  std::size_t n_ = 0;
  double a_[3][capacity], b_[3][capacity], c_[3][capacity], m_[6][capacity];
  double cubed_[capacity];
  float quality_[capacity];
  double minimum_ = 0, sum_ = 0;
};

} // namespace anistar
