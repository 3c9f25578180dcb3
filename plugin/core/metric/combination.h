#pragma once
// The intersection of two metric fields.

#include <cstddef>
#include <span>
#include <vector>

namespace anistar {

/// The intersection of the metrics M and N (full tensors, d * d numbers each, one after
/// the other): at least as fine as both in every direction, to round-off of the largest
/// entry. Simultaneous reduction; a second pass takes back what the first one rounds
/// off where the sizes differ by many orders of magnitude.
/// @pre both have the same length, and every tensor is positive definite.
template <std::size_t d>
[[nodiscard]] std::vector<double> intersected(std::span<const double> M,
                                              std::span<const double> N);

} // namespace anistar
