#pragma once
// NumPy arrays in and out: no silent conversion in, no copy out.

#include <cstdint>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <utility>
#include <vector>

namespace anistar::bindings {

namespace nb = nanobind;

template <class T, class Shape>
using Input = nb::ndarray<const T, Shape, nb::c_contig, nb::device::cpu>;
template <class T> using Array1 = Input<T, nb::shape<-1>>;
template <class T> using Array2 = Input<T, nb::shape<-1, -1>>;
template <class T> using Array3 = Input<T, nb::shape<-1, -1, -1>>;

/// Hands rows of numbers T over to NumPy as an array of the given shape,
/// without copy.
template <class T, class Row>
[[nodiscard]] nb::ndarray<nb::numpy, T>
owned_rows(std::vector<Row> &&rows, std::initializer_list<std::size_t> shape) {
  auto *kept = new std::vector<Row>(std::move(rows));
  nb::capsule owner(
      kept, [](void *p) noexcept { delete static_cast<std::vector<Row> *>(p); });
  return nb::ndarray<nb::numpy, T>(reinterpret_cast<T *>(kept->data()), shape, owner);
}

/// The same where a row is a number.
template <class T>
[[nodiscard]] nb::ndarray<nb::numpy, T>
owned(std::vector<T> &&values, std::initializer_list<std::size_t> shape) {
  return owned_rows<T>(std::move(values), shape);
}

/// The same array as an input.
template <class Array, class T>
[[nodiscard]] Array held(const nb::ndarray<nb::numpy, T> &array) {
  return nb::cast<Array>(nb::cast(array));
}

} // namespace anistar::bindings
