#pragma once
// Small vectors and symmetric tensors of dimension d: the algebra of metrics.

#include "base/elementary.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace anistar {

/// Unaligned, so that a row of a NumPy array can be read as one wherever it starts.
template <std::size_t d>
using Vector = Eigen::Matrix<double, static_cast<int>(d), 1, Eigen::DontAlign>;
template <std::size_t d>
using Matrix = Eigen::Matrix<double, static_cast<int>(d), static_cast<int>(d)>;

/// A symmetric tensor; its entries are the rows of the lower triangle:
/// xx, xy, yy in 2D and xx, xy, yy, xz, yz, zz in 3D (the order of Medit).
template <std::size_t d> struct SymmetricTensor {
  static constexpr std::size_t n_entries = d * (d + 1) / 2;
  std::array<double, n_entries> entries{};

  [[nodiscard]] static constexpr std::size_t index(std::size_t i, std::size_t j) {
    return i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i;
  }
  [[nodiscard]] double operator()(std::size_t i, std::size_t j) const {
    return entries[index(i, j)];
  }
  double &operator()(std::size_t i, std::size_t j) { return entries[index(i, j)]; }

  SymmetricTensor &operator+=(const SymmetricTensor &other) {
    for (std::size_t k = 0; k < n_entries; ++k)
      entries[k] += other.entries[k];
    return *this;
  }
  SymmetricTensor &operator*=(double factor) {
    for (double &entry : entries)
      entry *= factor;
    return *this;
  }
  friend SymmetricTensor operator+(SymmetricTensor a, const SymmetricTensor &b) {
    return a += b;
  }
  friend SymmetricTensor operator*(double factor, SymmetricTensor a) {
    return a *= factor;
  }
};

template <std::size_t d>
[[nodiscard]] Matrix<d> as_matrix(const SymmetricTensor<d> &M) {
  Matrix<d> full;
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = 0; j < d; ++j)
      full(static_cast<int>(i), static_cast<int>(j)) = M(i, j);
  return full;
}

template <std::size_t d>
[[nodiscard]] SymmetricTensor<d> as_tensor(const Matrix<d> &full) {
  SymmetricTensor<d> M;
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      M(i, j) = full(static_cast<int>(i), static_cast<int>(j));
  return M;
}

/// v^T M v.
template <std::size_t d>
[[nodiscard]] inline double quadratic(const SymmetricTensor<d> &M, const Vector<d> &v) {
  const auto &e = M.entries;
  if constexpr (d == 2)
    return e[0] * v[0] * v[0] + 2 * e[1] * v[0] * v[1] + e[2] * v[1] * v[1];
  else
    return e[0] * v[0] * v[0] + e[2] * v[1] * v[1] + e[5] * v[2] * v[2] +
           2 * (e[1] * v[0] * v[1] + e[3] * v[0] * v[2] + e[4] * v[1] * v[2]);
}

/// M v.
template <std::size_t d>
[[nodiscard]] inline Vector<d> product(const SymmetricTensor<d> &M,
                                       const Vector<d> &v) {
  Vector<d> out;
  for (std::size_t i = 0; i < d; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < d; ++j)
      sum += M(i, j) * v[static_cast<int>(j)];
    out[static_cast<int>(i)] = sum;
  }
  return out;
}

template <std::size_t d>
[[nodiscard]] inline double determinant(const SymmetricTensor<d> &M) {
  const auto &e = M.entries;
  if constexpr (d == 2)
    return e[0] * e[2] - e[1] * e[1];
  else
    return e[0] * (e[2] * e[5] - e[4] * e[4]) - e[1] * (e[1] * e[5] - e[4] * e[3]) +
           e[3] * (e[1] * e[4] - e[2] * e[3]);
}

namespace detail {
/// Determinant of a positive definite tensor with entries e, times e[0], by its Schur
/// complement. The round-off is relative to the condition number; to its square in
/// the expansion, which has no digit left when a metric is stretched 1e4 times.
[[nodiscard]] inline double definite_determinant_times_first(const double *e) {
  const double p = e[0] * e[2] - e[1] * e[1], q = e[0] * e[4] - e[1] * e[3],
               r = e[0] * e[5] - e[3] * e[3];
  return p * r - q * q;
}
} // namespace detail

/// @pre M is positive definite.
template <std::size_t d>
[[nodiscard]] inline double definite_determinant(const SymmetricTensor<d> &M) {
  if constexpr (d == 2)
    return determinant<2>(M);
  else
    return detail::definite_determinant_times_first(M.entries.data()) / M.entries[0];
}

/// Eigenvalues in increasing order, eigenvectors as columns.
template <std::size_t d> struct Spectrum {
  Vector<d> values;
  Matrix<d> vectors;
};

template <std::size_t d>
[[nodiscard]] inline Spectrum<d> spectrum(const SymmetricTensor<d> &M) {
  if constexpr (d == 2) {
    const double mean = .5 * (M(0, 0) + M(1, 1)), half = .5 * (M(0, 0) - M(1, 1));
    const double off = M(0, 1), radius = std::sqrt(half * half + off * off);
    double large = mean + radius, small = mean - radius;
    if (mean < 0)
      std::swap(large, small); // `large` has the larger modulus
    // the quotient is accurate where the difference cancels
    if (large != 0 && std::abs(small) < 1e-3 * std::abs(large))
      small = (M(0, 0) * M(1, 1) - off * off) / large;
    // eigenvector of the upper eigenvalue, from the row without cancellation
    double c = half >= 0 ? radius + half : off, s = half >= 0 ? off : radius - half;
    const double norm = std::sqrt(c * c + s * s);
    if (norm > 0) {
      c /= norm;
      s /= norm;
    } else {
      c = 1;
      s = 0;
    }
    const double upper = mean < 0 ? small : large, lower = mean < 0 ? large : small;
    Spectrum<2> out;
    out.values << lower, upper;
    out.vectors << -s, c, c, s;
    return out;
  } else {
    Eigen::SelfAdjointEigenSolver<Matrix<d>> solver(as_matrix(M));
    return {solver.eigenvalues(), solver.eigenvectors()};
  }
}

template <std::size_t d>
[[nodiscard]] inline SymmetricTensor<d> compose(const Vector<d> &values,
                                                const Matrix<d> &vectors) {
  SymmetricTensor<d> M;
  for (int i = 0; i < static_cast<int>(d); ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = 0;
      for (int k = 0; k < static_cast<int>(d); ++k)
        sum += values[k] * vectors(i, k) * vectors(j, k);
      M(i, j) = sum;
    }
  return M;
}

/// f(M) by the spectrum of M.
template <std::size_t d, class Function>
[[nodiscard]] inline SymmetricTensor<d> matrix_function(const SymmetricTensor<d> &M,
                                                        Function f) {
  Spectrum<d> s = spectrum(M);
  for (int k = 0; k < static_cast<int>(d); ++k)
    s.values[k] = f(s.values[k]);
  return compose<d>(s.values, s.vectors);
}

/// @pre M is positive definite.
template <std::size_t d>
[[nodiscard]] inline SymmetricTensor<d> log(const SymmetricTensor<d> &M) {
  return matrix_function(M, [](double x) { return elementary::log(x); });
}

namespace detail {
/// (exp a - exp b) / (a - b), given these exponentials.
[[nodiscard]] inline double exp_difference(double a, double b, double exp_a,
                                           double exp_b) {
  const double h = a - b;
  if (std::abs(h) > .1)
    return (exp_a - exp_b) / h;
  // (exp(h) - 1) / h by its series where the difference cancels: sum of h^k / (k + 1)!
  constexpr double c[] = {1.,       1. / 2,    1. / 6,     1. / 24,     1. / 120,
                          1. / 720, 1. / 5040, 1. / 40320, 1. / 362880, 1. / 3628800};
  const double h2 = h * h, h4 = h2 * h2;
  const double sum =
      (c[0] + c[1] * h) + h2 * (c[2] + c[3] * h) +
      h4 * ((c[4] + c[5] * h) + h2 * (c[6] + c[7] * h) + h4 * (c[8] + c[9] * h));
  return exp_b * sum;
}

/// cos(acos(cosine) / 3) for 0 <= cosine <= 1: the root of 4 t^3 - 3 t = cosine in
/// [sqrt(3) / 2, 1] by Newton steps, from a chord that is at most .01 away.
[[nodiscard]] inline double cosine_of_third(double cosine) {
  constexpr double at_zero = .8660254037844387;
  double t = at_zero + (1 - at_zero) * cosine;
  for (int step = 0; step < 3; ++step)
    t = (8 * t * t * t + cosine) / (12 * t * t - 3);
  return std::min(t, 1.);
}

/// Eigenvalues of a symmetric 3 x 3 tensor in decreasing order, to the square root of
/// the precision where two are close: enough as nodes of an interpolation.
[[nodiscard]] inline std::array<double, 3>
close_eigenvalues(const SymmetricTensor<3> &A) {
  const double mean = (A(0, 0) + A(1, 1) + A(2, 2)) / 3;
  SymmetricTensor<3> D = A;
  for (std::size_t i = 0; i < 3; ++i)
    D(i, i) -= mean;
  const double squares =
      D(0, 0) * D(0, 0) + D(1, 1) * D(1, 1) + D(2, 2) * D(2, 2) +
      2 * (D(0, 1) * D(0, 1) + D(0, 2) * D(0, 2) + D(1, 2) * D(1, 2));
  if (!(squares > 1e-24))
    return {mean, mean, mean};
  const double radius = std::sqrt(squares / 6);
  const double cosine =
      std::clamp(determinant<3>(D) / (2 * radius * radius * radius), -1., 1.);
  // the third of the angle is below 30 degrees when the tensor is turned round
  const double t = cosine_of_third(std::abs(cosine));
  const double far = 2 * radius * t;
  const double near = radius * (std::sqrt(3 * (1 - t * t)) + t);
  if (cosine >= 0)
    return {mean + far, mean - far + near, mean - near};
  return {mean + near, mean + far - near, mean - far};
}
} // namespace detail

template <std::size_t d>
[[nodiscard]] inline SymmetricTensor<d> exp(const SymmetricTensor<d> &L) {
  if constexpr (d == 3) {
    const auto [x, y, z] = detail::close_eigenvalues(L);
    // beyond this range the smallest eigenvalue would drown in the round-off
    constexpr double largest_range = 20;
    if (x - z < largest_range) {
      // Newton interpolation in x, y, z; exp is entire, so nearly equal nodes are fine
      const double exp_x = elementary::exp(x), exp_y = elementary::exp(y),
                   exp_z = elementary::exp(z);
      const double xy = detail::exp_difference(x, y, exp_x, exp_y),
                   yz = detail::exp_difference(y, z, exp_y, exp_z);
      // near each other: half of exp of their mean
      const double xyz =
          x - z > 1e-4 ? (xy - yz) / (x - z) : .5 * exp_y * (1 + (x - 2 * y + z) / 3);
      SymmetricTensor<d> A = L, B = L, out;
      for (std::size_t i = 0; i < d; ++i) {
        A(i, i) -= x;
        B(i, i) -= y;
      }
      for (std::size_t i = 0; i < d; ++i)
        for (std::size_t j = 0; j <= i; ++j)
          out(i, j) = xy * A(i, j) +
                      xyz * (A(i, 0) * B(0, j) + A(i, 1) * B(1, j) + A(i, 2) * B(2, j));
      for (std::size_t i = 0; i < d; ++i)
        out(i, i) += exp_x;
      return out;
    }
  }
  return matrix_function(L, [](double x) { return elementary::exp(x); });
}

/// The lower triangular L with L L^T = M.
/// @pre M is positive definite.
template <std::size_t d>
[[nodiscard]] inline Matrix<d> lower_factor(const SymmetricTensor<d> &M) {
  Matrix<d> L = Matrix<d>::Zero();
  for (int i = 0; i < static_cast<int>(d); ++i)
    for (int j = 0; j <= i; ++j) {
      double rest = M(i, j);
      for (int k = 0; k < j; ++k)
        rest -= L(i, k) * L(j, k);
      L(i, j) = i == j ? std::sqrt(rest) : rest / L(j, j);
    }
  return L;
}

/// L^-1 T L^-T for lower triangular L.
template <std::size_t d>
[[nodiscard]] inline SymmetricTensor<d> congruent(const Matrix<d> &L,
                                                  const SymmetricTensor<d> &T) {
  constexpr int n = static_cast<int>(d);
  Matrix<d> X = as_matrix(T);
  for (int i = 0; i < n; ++i) { // X = L^-1 T
    for (int j = 0; j < i; ++j)
      X.row(i) -= L(i, j) * X.row(j);
    X.row(i) /= L(i, i);
  }
  for (int i = 0; i < n; ++i) { // X = X L^-T
    for (int j = 0; j < i; ++j)
      X.col(i) -= L(i, j) * X.col(j);
    X.col(i) /= L(i, i);
  }
  return as_tensor<d>(X);
}

/// Whether bound * I - S is positive definite, by its leading minors.
template <std::size_t d>
[[nodiscard]] inline bool is_below(const SymmetricTensor<d> &S, double bound) {
  SymmetricTensor<d> D = -1.0 * S;
  for (std::size_t i = 0; i < d; ++i)
    D(i, i) += bound;
  if (!(D(0, 0) > 0) || !(D(0, 0) * D(1, 1) - D(0, 1) * D(0, 1) > 0))
    return false;
  if constexpr (d == 2)
    return true;
  else
    return determinant(D) > 0;
}

/// The spectrum of a positive definite tensor by Jacobi rotations, in no order. Small
/// eigenvalues are as accurate as the entries allow however large the others are [1];
/// methods that reduce to tridiagonal form lose what lies below the largest by 1e16.
/// [1] Demmel, Veselic, Jacobi's method is more accurate than QR, SIAM J. Matrix Anal.
/// Appl. 13, 1992.
/// @pre M is positive definite, or semidefinite up to round-off.
template <std::size_t d>
[[nodiscard]] inline Spectrum<d> definite_spectrum(const SymmetricTensor<d> &M) {
  constexpr int n = static_cast<int>(d);
  constexpr int max_sweeps = 16;              // 4 to 6 are needed, quadratic at the end
  constexpr double negligible_square = 1e-32; // of b^2 / (a c): below round-off
  Matrix<d> A = as_matrix(M), V = Matrix<d>::Identity();
  bool rotated = true;
  for (int sweep = 0; rotated && sweep < max_sweeps; ++sweep) {
    rotated = false;
    for (int p = 0; p < n; ++p)
      for (int q = p + 1; q < n; ++q) {
        const double a = A(p, p), b = A(p, q), c = A(q, q);
        if (!(b * b > negligible_square * std::abs(a * c)))
          continue;
        rotated = true;
        const double cotangent = (c - a) / (2 * b);
        const double t = std::copysign(1.0, cotangent) /
                         (std::abs(cotangent) + std::sqrt(1 + cotangent * cotangent));
        const double cosine = 1 / std::sqrt(1 + t * t), sine = t * cosine;
        A(p, p) = a - t * b;
        A(q, q) = c + t * b;
        A(p, q) = A(q, p) = 0;
        for (int r = 0; r < n; ++r) {
          if (r != p && r != q) {
            const double x = A(r, p), y = A(r, q);
            A(r, p) = A(p, r) = cosine * x - sine * y;
            A(r, q) = A(q, r) = sine * x + cosine * y;
          }
          const double x = V(r, p), y = V(r, q);
          V(r, p) = cosine * x - sine * y;
          V(r, q) = sine * x + cosine * y;
        }
      }
  }
  Spectrum<d> out;
  out.values = A.diagonal();
  out.vectors = V;
  return out;
}

/// Replaces M by its intersection with N (simultaneous reduction: the larger value on
/// each axis of their common basis) where N exceeds M by a factor of 1 + `tolerance`
/// somewhere; returns whether it did. What is added is semidefinite: M never gets
/// coarser.
/// @pre M and N are positive definite.
template <std::size_t d>
inline bool raise(SymmetricTensor<d> &M, const SymmetricTensor<d> &N,
                  double tolerance) {
  const Matrix<d> L = lower_factor(M);
  const SymmetricTensor<d> S = congruent<d>(L, N);
  if (is_below(S, 1 + tolerance))
    return false;
  Spectrum<d> s = definite_spectrum(S);
  if (!(s.values.maxCoeff() > 1 + tolerance))
    return false;
  for (int k = 0; k < static_cast<int>(d); ++k)
    s.values[k] = std::max(s.values[k] - 1, 0.0);
  M += compose<d>(s.values, L * s.vectors);
  return true;
}

} // namespace anistar
