#pragma once
// NumPy arrays as spans of the core's points and cells.

#include "base/tensor.h"
#include "bindings/support/arrays.h"
#include "mesh/adjacency.h"

#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace anistar::bindings {

template <std::size_t d>
[[nodiscard]] std::span<const Vector<d>> points_of(const Array2<double> &array) {
  static_assert(sizeof(Vector<d>) == d * sizeof(double));
  if (array.shape(1) != d)
    throw std::invalid_argument("points have " + std::to_string(array.shape(1)) +
                                " columns, expected " + std::to_string(d));
  return {reinterpret_cast<const Vector<d> *>(array.data()), array.shape(0)};
}

template <std::size_t d>
[[nodiscard]] std::span<const Cell<d>> cells_of(const Array2<Index> &array) {
  if (array.shape(1) != d + 1)
    throw std::invalid_argument("cells have " + std::to_string(array.shape(1)) +
                                " columns, expected " + std::to_string(d + 1));
  return {reinterpret_cast<const Cell<d> *>(array.data()), array.shape(0)};
}

template <std::size_t d>
[[nodiscard]] std::span<const Facet<d>> facets_of(const Array2<Index> &array) {
  if (array.shape(1) != d)
    throw std::invalid_argument("facets have " + std::to_string(array.shape(1)) +
                                " columns, expected " + std::to_string(d));
  return {reinterpret_cast<const Facet<d> *>(array.data()), array.shape(0)};
}

[[nodiscard]] inline std::span<const std::array<Index, 2>>
pairs_of(const Array2<Index> &edges) {
  if (edges.shape(1) != 2)
    throw std::invalid_argument("edges have " + std::to_string(edges.shape(1)) +
                                " columns, expected 2");
  return {reinterpret_cast<const std::array<Index, 2> *>(edges.data()), edges.shape(0)};
}

[[nodiscard]] inline std::span<const Index> indices_of(const Array1<Index> &array) {
  return {array.data(), array.shape(0)};
}

template <std::size_t d>
[[nodiscard]] SymmetricTensor<d> tensor_of(const Array2<double> &metric) {
  if (metric.shape(0) != d || metric.shape(1) != d)
    throw std::invalid_argument("metric is not of shape (" + std::to_string(d) + ", " +
                                std::to_string(d) + ")");
  SymmetricTensor<d> M;
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      M(i, j) = metric(i, j);
  return M;
}

template <std::size_t d>
[[nodiscard]] std::vector<SymmetricTensor<d>> tensors_of(const Array3<double> &array) {
  if (array.shape(1) != d || array.shape(2) != d)
    throw std::invalid_argument("metric is not of shape (n, " + std::to_string(d) +
                                ", " + std::to_string(d) + ")");
  std::vector<SymmetricTensor<d>> out(array.shape(0));
  const double *entry = array.data();
  for (SymmetricTensor<d> &M : out)
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t j = 0; j < d; ++j, ++entry)
        if (j <= i)
          M(i, j) = *entry;
  return out;
}

/// Rows of plain numbers as an (n, width) array, without copy.
template <class T, std::size_t width, class Row>
[[nodiscard]] nb::ndarray<nb::numpy, T> rows(std::vector<Row> &&values) {
  static_assert(sizeof(Row) == width * sizeof(T));
  return owned_rows<T>(std::move(values), {values.size(), width});
}

} // namespace anistar::bindings
