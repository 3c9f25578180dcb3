#pragma once
// NumPy arrays as spans of the core's points and cells.

#include "../adjacency.h"
#include "../tensor.h"
#include "arrays.h"

#include <cstring>
#include <span>
#include <stdexcept>
#include <string>

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

} // namespace anistar::bindings
