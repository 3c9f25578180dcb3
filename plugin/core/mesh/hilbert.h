#pragma once
// The Hilbert curve: an order of points in which neighbours in memory are neighbours in
// space, which is what the speed of every walk and every sweep depends on.

#include "base/tensor.h"

#include <cstdint>
#include <span>
#include <vector>

namespace anistar {

/// Indices of `points` in the order in which a Hilbert curve through a box around them
/// visits them; ties keep the given order.
/// @param shift 0 for their bounding cube; else the cube is larger, by that fraction of
/// its extent below and twice that above, so that the curve turns elsewhere
template <std::size_t d>
[[nodiscard]] std::vector<std::int32_t>
hilbert_order(std::span<const Vector<d>> points, int threads = 1, double shift = 0);

} // namespace anistar
