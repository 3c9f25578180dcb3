#pragma once
// Systems with a sparse symmetric matrix, solved by conjugate residuals.

#include "mesh/adjacency.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace anistar {

/// The rows of a square sparse matrix that somebody else holds.
struct SparseView {
  std::span<const std::int64_t> starts;
  std::span<const Index> columns;
  std::span<const double> values;
};

enum class SystemStop {
  solved,        ///< the residual is down to its bound
  least_squares, ///< what is left of it the matrix does not reach
  step_limit,
  not_finite
};

struct SystemSolution {
  std::vector<double> values;
  double residual; ///< its norm beside that of the right-hand side, both scaled
  std::size_t steps;
  SystemStop stop;
};

struct SystemBounds {
  double residual; ///< relative to the right-hand side
  std::size_t max_steps;
  std::function<void()> look; ///< called in every step; may throw, to interrupt
};

/// A symmetric positive semi-definite system, scaled to a unit diagonal. Conjugate
/// residuals cost what conjugate gradients cost, and end in a least-squares solution
/// where the matrix is singular. All sums are taken in one order, on one thread.
/// Source: Saad, Iterative Methods for Sparse Linear Systems, 2003, Algorithm 6.20.
class SymmetricSystem {
public:
  /// @throws std::invalid_argument when the rows are no square matrix, or an entry of
  /// the diagonal is not positive.
  explicit SymmetricSystem(const SparseView &matrix);

  [[nodiscard]] std::size_t size() const { return scale_.size(); }

  /// @pre `right` and `start` have an entry for each row.
  [[nodiscard]] SystemSolution solved(std::span<const double> right,
                                      std::span<const double> start,
                                      const SystemBounds &bounds) const;

private:
  std::vector<std::int64_t> starts_;
  std::vector<Index> columns_;
  std::vector<double> values_, scale_;
  double norm_ = 0; ///< not below the largest eigenvalue of the scaled matrix

  struct Products {
    double energy, square; ///< x·y and y·y
  };
  /// y = S x with the scaled matrix S.
  Products multiply(const std::vector<double> &x, std::vector<double> &y) const;
  /// In the scaled unknowns, from x; r is the right-hand side.
  [[nodiscard]] SystemSolution iterated(std::vector<double> x, std::vector<double> r,
                                        const SystemBounds &bounds) const;
};

} // namespace anistar
