#pragma once
// The spectra of many symmetric tensors at once, in an arithmetic of fixed order.

#include <cstddef>
#include <span>
#include <vector>

namespace anistar {

/// Of n tensors, one after the other: d eigenvalues each in increasing order, and the
/// eigenvectors in the columns of d x d matrices, by rows.
struct Spectra {
  std::vector<double> values, vectors;
};

/// By Jacobi rotations, which find small eigenvalues of definite tensors as accurately
/// as the entries allow, see `definite_spectrum`. What comes out for one tensor does
/// not depend on its neighbours.
/// @param tensors n full d x d matrices; the lower triangles are read
template <std::size_t d> [[nodiscard]] Spectra spectra(std::span<const double> tensors);

/// vectors diag(values) vectors^T, full and exactly symmetric.
template <std::size_t d>
[[nodiscard]] std::vector<double> composed(std::span<const double> values,
                                           std::span<const double> vectors);

/// The products of n pairs of d x d matrices.
template <std::size_t d>
[[nodiscard]] std::vector<double> products(std::span<const double> first,
                                           std::span<const double> second);

} // namespace anistar
