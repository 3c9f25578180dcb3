#include "metric/spectra.h"

#include <algorithm>
#include <cmath>

namespace anistar {
namespace {

/// Tensors that are rotated side by side, so that the compiler fills its registers.
constexpr std::size_t lanes = 8;
/// Of Jacobi rotations; 4 to 6 are needed, with quadratic convergence at the end.
constexpr int max_sweeps = 24;
/// An entry b is round-off beside the diagonal entries a and c when b^2 is below this
/// times a c, and beside a zero when it is below the smallest square.
constexpr double negligible_square = 1e-32, smallest_square = 1e-300;

template <std::size_t d> class Block {
public:
  void load(const double *tensors, std::size_t count) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double *T = tensors + std::min(lane, count - 1) * d * d;
      double size = 0;
      for (std::size_t i = 0; i < d; ++i)
        for (std::size_t j = 0; j <= i; ++j)
          size = std::max(size, std::abs(T[i * d + j]));
      scale_[lane] = power_of_two(size);
      for (std::size_t i = 0; i < d; ++i)
        for (std::size_t j = 0; j < d; ++j) {
          A_[i][j][lane] = T[std::max(i, j) * d + std::min(i, j)] / scale_[lane];
          V_[i][j][lane] = i == j;
        }
    }
  }

  void diagonalise() {
    for (int sweep = 0; sweep < max_sweeps; ++sweep) {
      bool rotated = false;
      for (std::size_t p = 0; p < d; ++p)
        for (std::size_t q = p + 1; q < d; ++q)
          rotated |= rotate(p, q);
      if (!rotated)
        return;
    }
  }

  void store(std::size_t count, double *values, double *vectors) const {
    for (std::size_t lane = 0; lane < count; ++lane) {
      std::size_t order[d];
      for (std::size_t k = 0; k < d; ++k)
        order[k] = k;
      std::sort(order, order + d, [&](std::size_t i, std::size_t j) {
        return A_[i][i][lane] < A_[j][j][lane] ||
               (A_[i][i][lane] == A_[j][j][lane] && i < j);
      });
      for (std::size_t k = 0; k < d; ++k) {
        values[lane * d + k] = A_[order[k]][order[k]][lane] * scale_[lane];
        for (std::size_t i = 0; i < d; ++i)
          vectors[(lane * d + i) * d + k] = V_[i][order[k]][lane];
      }
    }
  }

private:
  double A_[d][d][lanes], V_[d][d][lanes], scale_[lanes];

  /// Products of scaled entries stay in the range of doubles, and no digit changes.
  static double power_of_two(double size) {
    int exponent = 0;
    std::frexp(size, &exponent);
    return size > 0 ? std::ldexp(1.0, std::clamp(exponent, -1000, 1000)) : 1;
  }

  /// Makes the entries (p, q) zero where they are more than round-off; whether any was.
  bool rotate(std::size_t p, std::size_t q) {
    double sine[lanes], cosine[lanes], tangent[lanes];
    bool any = false;
    for (std::size_t l = 0; l < lanes; ++l) {
      const double a = A_[p][p][l], b = A_[p][q][l], c = A_[q][q][l];
      const bool active =
          b * b > std::max(negligible_square * std::abs(a * c), smallest_square);
      const double cotangent = (c - a) / (2 * (active ? b : 1));
      const double t = std::copysign(1.0, cotangent) /
                       (std::abs(cotangent) + std::sqrt(1 + cotangent * cotangent));
      tangent[l] = active ? t : 0;
      cosine[l] = 1 / std::sqrt(1 + tangent[l] * tangent[l]);
      sine[l] = tangent[l] * cosine[l];
      any |= active;
    }
    if (!any)
      return false;
    for (std::size_t l = 0; l < lanes; ++l) {
      const double step = tangent[l] * A_[p][q][l];
      A_[p][p][l] -= step;
      A_[q][q][l] += step;
      A_[p][q][l] = A_[q][p][l] = tangent[l] != 0 ? 0 : A_[p][q][l];
    }
    for (std::size_t r = 0; r < d; ++r) {
      if (r != p && r != q) {
        turn(A_[r][p], A_[r][q], sine, cosine);
        std::copy(A_[r][p], A_[r][p] + lanes, A_[p][r]);
        std::copy(A_[r][q], A_[r][q] + lanes, A_[q][r]);
      }
      turn(V_[r][p], V_[r][q], sine, cosine);
    }
    return true;
  }

  static void turn(double *x, double *y, const double *sine, const double *cosine) {
    for (std::size_t l = 0; l < lanes; ++l) {
      const double first = cosine[l] * x[l] - sine[l] * y[l];
      y[l] = sine[l] * x[l] + cosine[l] * y[l];
      x[l] = first;
    }
  }
};

} // namespace

template <std::size_t d> Spectra spectra(std::span<const double> tensors) {
  const std::size_t n = tensors.size() / (d * d);
  Spectra out{std::vector<double>(n * d), std::vector<double>(n * d * d)};
  Block<d> block;
  for (std::size_t first = 0; first < n; first += lanes) {
    const std::size_t count = std::min(lanes, n - first);
    block.load(&tensors[first * d * d], count);
    block.diagonalise();
    block.store(count, &out.values[first * d], &out.vectors[first * d * d]);
  }
  return out;
}

template <std::size_t d>
std::vector<double> composed(std::span<const double> values,
                             std::span<const double> vectors) {
  const std::size_t n = values.size() / d;
  std::vector<double> tensors(n * d * d);
  for (std::size_t v = 0; v < n; ++v) {
    const double *lambda = &values[v * d], *V = &vectors[v * d * d];
    double *T = &tensors[v * d * d];
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = 0;
        for (std::size_t k = 0; k < d; ++k)
          sum += lambda[k] * V[i * d + k] * V[j * d + k];
        T[i * d + j] = T[j * d + i] = sum;
      }
  }
  return tensors;
}

template <std::size_t d>
std::vector<double> products(std::span<const double> first,
                             std::span<const double> second) {
  std::vector<double> out(first.size());
  for (std::size_t start = 0; start < out.size(); start += d * d) {
    const double *A = &first[start], *B = &second[start];
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t k = 0; k < d; ++k) {
        double sum = 0;
        for (std::size_t j = 0; j < d; ++j)
          sum += A[i * d + j] * B[j * d + k];
        out[start + i * d + k] = sum;
      }
  }
  return out;
}

template Spectra spectra<2>(std::span<const double>);
template Spectra spectra<3>(std::span<const double>);
template std::vector<double> composed<2>(std::span<const double>,
                                         std::span<const double>);
template std::vector<double> composed<3>(std::span<const double>,
                                         std::span<const double>);
template std::vector<double> products<2>(std::span<const double>,
                                         std::span<const double>);
template std::vector<double> products<3>(std::span<const double>,
                                         std::span<const double>);

} // namespace anistar
