#include "metric/spectra.h"
#include "bindings/bind.h"
#include "bindings/support/arrays.h"

#include <stdexcept>

namespace anistar::bindings {
namespace {

std::size_t dimension(std::size_t rows, std::size_t columns) {
  if (rows != columns || (rows != 2 && rows != 3))
    throw std::invalid_argument("tensors must have shape (n, 2, 2) or (n, 3, 3)");
  return rows;
}

nb::tuple of_tensors(Array3<double> tensors) {
  const std::size_t n = tensors.shape(0);
  const std::size_t d = dimension(tensors.shape(1), tensors.shape(2));
  Spectra found;
  {
    nb::gil_scoped_release release;
    const std::span<const double> T(tensors.data(), tensors.size());
    found = d == 2 ? spectra<2>(T) : spectra<3>(T);
  }
  return nb::make_tuple(owned(std::move(found.values), {n, d}),
                        owned(std::move(found.vectors), {n, d, d}));
}

nb::ndarray<nb::numpy, double> compose(Array2<double> values, Array3<double> vectors) {
  const std::size_t n = vectors.shape(0);
  const std::size_t d = dimension(vectors.shape(1), vectors.shape(2));
  if (values.shape(0) != n || values.shape(1) != d)
    throw std::invalid_argument("values must have shape (n, d) for vectors (n, d, d)");
  std::vector<double> tensors;
  {
    nb::gil_scoped_release release;
    const std::span<const double> lambda(values.data(), values.size());
    const std::span<const double> V(vectors.data(), vectors.size());
    tensors = d == 2 ? composed<2>(lambda, V) : composed<3>(lambda, V);
  }
  return owned(std::move(tensors), {n, d, d});
}

nb::ndarray<nb::numpy, double> product(Array3<double> first, Array3<double> second) {
  const std::size_t n = first.shape(0);
  const std::size_t d = dimension(first.shape(1), first.shape(2));
  if (second.shape(0) != n || second.shape(1) != d || second.shape(2) != d)
    throw std::invalid_argument("both factors must have one shape (n, d, d)");
  std::vector<double> out;
  {
    nb::gil_scoped_release release;
    const std::span<const double> A(first.data(), first.size());
    const std::span<const double> B(second.data(), second.size());
    out = d == 2 ? products<2>(A, B) : products<3>(A, B);
  }
  return owned(std::move(out), {n, d, d});
}

} // namespace

void bind_spectra(nb::module_ &module) {
  module.def("spectra", &of_tensors, nb::arg("tensors").noconvert(),
             "Eigenvalues (n, d), increasing, and eigenvectors (n, d, d) in columns of "
             "symmetric tensors (n, d, d).");
  module.def("compose", &compose, nb::arg("values").noconvert(),
             nb::arg("vectors").noconvert(),
             "The tensors (n, d, d) with the given eigenvalues and eigenvectors.");
  module.def("product", &product, nb::arg("first").noconvert(),
             nb::arg("second").noconvert(), "The products of matrices (n, d, d).");
}

} // namespace anistar::bindings
