#pragma once
// How well a mesh fits its metric: the figures of every report.

#include "mesh/measures.h"

#include <span>
#include <vector>

namespace anistar {

struct Statistics {
  /// Bounds of the bins of `length_histogram`: below the first, between, above the
  /// last.
  static constexpr double length_bins[] = {.25, .5,  shortest_unit, .8, .9,
                                           1.1, 1.2, longest_unit,  2,  4};
  static constexpr std::size_t n_quality_bins = 10; ///< of equal width over [0, 1]

  std::size_t n_edges = 0;
  double unit_fraction = 0, length_min = 0, length_mean = 0, length_max = 0;
  std::vector<std::size_t> length_histogram;
  double quality_min = 0, quality_mean = 0;
  std::vector<std::size_t> quality_histogram;
};

/// Edge lengths and qualities by the metric at the vertices.
[[nodiscard]] Statistics measure(std::span<const Vertex<2>> vertices,
                                 std::span<const Cell<2>> cells,
                                 std::span<const Neighbours<2>> neighbours,
                                 int threads);
/// @param edges of the cells, each once
[[nodiscard]] Statistics measure(std::span<const Vertex<3>> vertices,
                                 std::span<const Cell<3>> cells,
                                 std::span<const std::array<Index, 2>> edges,
                                 int threads);

/// Quantiles of ln gamma, the logarithm of the distortion between the metrics at the
/// two ends of an edge: what decides whether stars can agree.
struct DistortionQuantiles {
  double p50 = 0, p90 = 0, p99 = 0, maximum = 0;
};
[[nodiscard]] DistortionQuantiles
distortion_quantiles(std::span<const Vertex<2>> vertices,
                     std::span<const Cell<2>> cells, int threads);
[[nodiscard]] DistortionQuantiles
distortion_quantiles(std::span<const Vertex<3>> vertices,
                     std::span<const std::array<Index, 2>> edges, int threads);
[[nodiscard]] DistortionQuantiles
distortion_quantiles(std::span<const Vertex<3>> vertices,
                     std::span<const Cell<3>> cells, int threads);

/// gamma(M, N) = max(|F_M^-1 F_N|, |F_N^-1 F_M|), the distortion between two metrics
/// (RR-7712 v2, section 2).
[[nodiscard]] double distortion(const SymmetricTensor<2> &M,
                                const SymmetricTensor<2> &N);
[[nodiscard]] double distortion(const SymmetricTensor<3> &M,
                                const SymmetricTensor<3> &N);

} // namespace anistar
