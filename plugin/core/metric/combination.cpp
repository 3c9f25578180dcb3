#include "metric/combination.h"
#include "base/tensor.h"

namespace anistar {
namespace {

template <std::size_t d> SymmetricTensor<d> tensor_at(const double *full) {
  SymmetricTensor<d> M;
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      M(i, j) = full[i * d + j];
  return M;
}

/// Adds to M what N has more, by the spectrum of N in the basis L L^T = M; returns the
/// ratio of the largest to the smallest eigenvalue, 0 where there was nothing to add.
template <std::size_t d>
double add_excess(SymmetricTensor<d> &M, const Matrix<d> &L,
                  const SymmetricTensor<d> &N_in_M) {
  Spectrum<d> s = definite_spectrum(N_in_M);
  const double largest = s.values.maxCoeff(), smallest = s.values.minCoeff();
  if (!(largest > 1))
    return 0;
  for (int k = 0; k < static_cast<int>(d); ++k)
    s.values[k] = std::max(s.values[k] - 1, 0.0);
  M += compose<d>(s.values, L * s.vectors);
  return largest / smallest;
}

template <std::size_t d>
bool intersect(SymmetricTensor<d> &M, const SymmetricTensor<d> &N) {
  constexpr double wide = 1e5; // beyond, one pass loses digits that a second gives back
  const Matrix<d> L = lower_factor(M);
  const SymmetricTensor<d> N_in_M = congruent<d>(L, N);
  if (is_below(N_in_M, 1))
    return false;
  const double ratio = add_excess<d>(M, L, N_in_M);
  if (!(ratio >= 0 && ratio < wide)) {
    const Matrix<d> again = lower_factor(M);
    add_excess<d>(M, again, congruent<d>(again, N));
  }
  return true;
}

} // namespace

template <std::size_t d>
std::vector<double> intersected(std::span<const double> M, std::span<const double> N) {
  std::vector<double> result(M.begin(), M.end());
  for (std::size_t start = 0; start < M.size(); start += d * d) {
    SymmetricTensor<d> R = tensor_at<d>(&M[start]);
    if (!intersect(R, tensor_at<d>(&N[start])))
      continue;
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t j = 0; j < d; ++j)
        result[start + i * d + j] = R(i, j);
  }
  return result;
}

template std::vector<double> intersected<2>(std::span<const double>,
                                            std::span<const double>);
template std::vector<double> intersected<3>(std::span<const double>,
                                            std::span<const double>);

} // namespace anistar
