#include "transfer/symmetric_system.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace anistar {
namespace {

/// The matrix does not reach a residual of which its product is below this part of the
/// largest that the product can be.
constexpr double round_off = 1e-14;

/// Keeps squares of the values in range and changes no digit of them.
double power_of_two(std::span<const double> values) {
  double largest = 0;
  for (const double value : values)
    largest = std::max(largest, std::abs(value));
  int exponent = 0;
  std::frexp(largest, &exponent);
  return std::ldexp(1., exponent - 1);
}

/// The sum of term(i) for 0 <= i < n, in four parts: one would wait for each addition.
template <class Term> double sum_of(std::size_t n, Term term) {
  double parts[4] = {0, 0, 0, 0};
  const std::size_t whole = n - n % 4;
  for (std::size_t i = 0; i < whole; i += 4)
    for (std::size_t k = 0; k < 4; ++k)
      parts[k] += term(i + k);
  for (std::size_t i = whole; i < n; ++i)
    parts[i - whole] += term(i);
  return (parts[0] + parts[1]) + (parts[2] + parts[3]);
}

void check_rows(const SparseView &matrix) {
  const std::size_t n = matrix.starts.size() - 1;
  if (matrix.starts.empty() || matrix.starts[0] != 0 ||
      matrix.columns.size() != matrix.values.size() ||
      std::cmp_not_equal(matrix.starts[n], matrix.columns.size()))
    throw std::invalid_argument("the starts do not fit the entries of the matrix");
  for (std::size_t i = 0; i < n; ++i)
    if (matrix.starts[i] > matrix.starts[i + 1])
      throw std::invalid_argument("the starts decrease at row " + std::to_string(i));
  for (const Index column : matrix.columns)
    if (column < 0 || std::cmp_greater_equal(column, n))
      throw std::invalid_argument("column " + std::to_string(column) +
                                  " is out of range for " + std::to_string(n) +
                                  " rows");
}

} // namespace

SymmetricSystem::SymmetricSystem(const SparseView &matrix)
    : starts_(matrix.starts.begin(), matrix.starts.end()),
      columns_(matrix.columns.begin(), matrix.columns.end()),
      values_(matrix.values.begin(), matrix.values.end()) {
  check_rows(matrix);
  scale_.assign(starts_.size() - 1, 0.);
  const auto row = [&](std::size_t i, auto visit) {
    for (auto k = starts_[i]; k < starts_[i + 1]; ++k)
      visit(k, columns_[k]);
  };
  for (std::size_t i = 0; i < size(); ++i) {
    row(i, [&](std::size_t k, std::size_t j) { scale_[i] += i == j ? values_[k] : 0; });
    if (!(scale_[i] > 0) || !std::isfinite(scale_[i]))
      throw std::invalid_argument(
          "entry " + std::to_string(i) +
          " of the diagonal is not positive: " + std::to_string(scale_[i]));
    scale_[i] = 1 / std::sqrt(scale_[i]);
  }
  for (std::size_t i = 0; i < size(); ++i) {
    double sum = 0;
    row(i, [&](std::size_t k, std::size_t j) {
      values_[k] = scale_[i] * values_[k] * scale_[j];
      sum += std::abs(values_[k]);
    });
    norm_ = std::max(norm_, sum);
  }
}

SymmetricSystem::Products SymmetricSystem::multiply(const std::vector<double> &x,
                                                    std::vector<double> &y) const {
  Products products{0, 0};
  for (std::size_t i = 0; i < size(); ++i) {
    double sum = 0;
    for (auto k = starts_[i]; k < starts_[i + 1]; ++k)
      sum += values_[k] * x[columns_[k]];
    y[i] = sum;
    products.energy += x[i] * sum;
    products.square += sum * sum;
  }
  return products;
}

SystemSolution SymmetricSystem::solved(std::span<const double> right,
                                       std::span<const double> start,
                                       const SystemBounds &bounds) const {
  const std::size_t n = size();
  const double unit = power_of_two(right);
  std::vector<double> x(n), b(n);
  for (std::size_t i = 0; i < n; ++i)
    b[i] = scale_[i] * (right[i] / unit);
  // Again: the diagonal may be so small that squares of its roots are none.
  const double scaled_unit = power_of_two(b);
  for (std::size_t i = 0; i < n; ++i) {
    b[i] /= scaled_unit;
    x[i] = start[i] / unit / scale_[i] / scaled_unit;
  }
  SystemSolution found = iterated(std::move(x), std::move(b), bounds);
  for (std::size_t i = 0; i < n; ++i)
    found.values[i] = scale_[i] * (scaled_unit * found.values[i]) * unit;
  return found;
}

SystemSolution SymmetricSystem::iterated(std::vector<double> x, std::vector<double> r,
                                         const SystemBounds &bounds) const {
  const std::size_t n = size();
  std::vector<double> p(n, 0.), Sr(n), Sp(n, 0.);
  const auto squared = [](const std::vector<double> &v) {
    return sum_of(v.size(), [&](std::size_t i) { return v[i] * v[i]; });
  };
  const double whole = std::sqrt(squared(r));
  multiply(x, Sr);
  for (std::size_t i = 0; i < n; ++i)
    r[i] -= Sr[i];

  double norm = std::sqrt(squared(r)), last_energy = 1;
  const auto ended = [&](std::size_t steps, SystemStop stop) -> SystemSolution {
    return {std::move(x), whole > 0 ? norm / whole : norm, steps, stop};
  };
  for (std::size_t step = 0;; ++step) {
    bounds.look();
    if (!std::isfinite(norm))
      return ended(step, SystemStop::not_finite);
    if (norm <= bounds.residual * whole)
      return ended(step, SystemStop::solved);
    const Products products = multiply(r, Sr);
    if (std::sqrt(products.square) <= round_off * norm_ * norm)
      return ended(step, SystemStop::least_squares);
    if (step == bounds.max_steps)
      return ended(step, SystemStop::step_limit);
    const double beta = step == 0 ? 0. : products.energy / last_energy;
    last_energy = products.energy;
    const double alpha = last_energy / sum_of(n, [&](std::size_t i) {
                           p[i] = r[i] + beta * p[i];
                           Sp[i] = Sr[i] + beta * Sp[i];
                           return Sp[i] * Sp[i];
                         });
    norm = std::sqrt(sum_of(n, [&](std::size_t i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * Sp[i];
      return r[i] * r[i];
    }));
  }
}

} // namespace anistar
