#pragma once
// Nearest points in a metric.

#include "base/tensor.h"
#include "mesh/adjacency.h"

#include <span>
#include <vector>

namespace anistar {

/// For every query the point nearest to it in the query's own metric; of points equally
/// near, the first.
///
/// @param seeds a point near each query, the nearer the faster.
/// @pre metrics positive definite, seeds valid.
template <std::size_t d>
[[nodiscard]] std::vector<Index>
nearest_in_metric(std::span<const Vector<d>> points, std::span<const Vector<d>> queries,
                  std::span<const SymmetricTensor<d>> metrics,
                  std::span<const Index> seeds);

} // namespace anistar
