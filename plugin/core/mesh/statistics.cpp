#include "mesh/statistics.h"

#include "base/parallel.h"

namespace anistar {
namespace {

/// Sums over some of the cells.
struct Sums {
  double length = 0, quality = 0;
  double length_min = std::numeric_limits<double>::infinity(), length_max = 0;
  double quality_min = std::numeric_limits<double>::infinity();
  std::size_t n_edges = 0, n_unit = 0;
  std::array<std::size_t, std::size(Statistics::length_bins) + 1> lengths{};
  std::array<std::size_t, Statistics::n_quality_bins> qualities{};

  void add_cell(double q) {
    quality += q;
    quality_min = std::min(quality_min, q);
    const double bin = std::clamp(q, 0., 1.) * Statistics::n_quality_bins;
    ++qualities[std::min(Statistics::n_quality_bins - 1,
                         static_cast<std::size_t>(bin))];
  }
  void add_edge(double l) {
    const std::span bins(Statistics::length_bins);
    ++n_edges;
    length += l;
    length_min = std::min(length_min, l);
    length_max = std::max(length_max, l);
    n_unit += l >= shortest_unit && l <= longest_unit;
    ++lengths[std::upper_bound(bins.begin(), bins.end(), l) - bins.begin()];
  }
  Sums &operator+=(const Sums &other) {
    length += other.length;
    quality += other.quality;
    length_min = std::min(length_min, other.length_min);
    length_max = std::max(length_max, other.length_max);
    quality_min = std::min(quality_min, other.quality_min);
    n_edges += other.n_edges;
    n_unit += other.n_unit;
    for (std::size_t k = 0; k < lengths.size(); ++k)
      lengths[k] += other.lengths[k];
    for (std::size_t k = 0; k < qualities.size(); ++k)
      qualities[k] += other.qualities[k];
    return *this;
  }
};

/// Adds up what add(sums, k) says of k = 0, ..., size - 1.
template <class Add> Sums summed(std::size_t size, int threads, Add add) {
  // parts of a fixed size, so that the sums do not depend on the number of threads
  constexpr std::size_t grain = 1 << 14;
  std::vector<Sums> parts((size + grain - 1) / grain);
  parallel_items(parts.size(), threads, [&] {
    return [&](std::size_t part) {
      Sums sums;
      for (std::size_t k = part * grain; k < std::min(size, (part + 1) * grain); ++k)
        add(sums, k);
      parts[part] = sums;
    };
  });
  Sums all;
  for (const Sums &part : parts)
    all += part;
  return all;
}

Statistics statistics_of(const Sums &all, std::size_t n_cells) {
  Statistics out;
  out.n_edges = all.n_edges;
  const double n_edges = static_cast<double>(std::max<std::size_t>(all.n_edges, 1));
  out.unit_fraction = static_cast<double>(all.n_unit) / n_edges;
  out.length_min = all.length_min;
  out.length_mean = all.length / n_edges;
  out.length_max = all.length_max;
  out.length_histogram.assign(all.lengths.begin(), all.lengths.end());
  out.quality_min = all.quality_min;
  out.quality_mean =
      all.quality / static_cast<double>(std::max<std::size_t>(n_cells, 1));
  out.quality_histogram.assign(all.qualities.begin(), all.qualities.end());
  return out;
}

/// Quantiles of the logarithm of some values.
DistortionQuantiles quantiles(std::vector<double> values) {
  if (values.empty())
    return {};
  auto sorted = values.begin(); // what lies before is below all that follows
  const auto quantile = [&](double q) {
    const auto k = static_cast<std::ptrdiff_t>(q * double(values.size() - 1));
    const auto at = values.begin() + k;
    std::nth_element(sorted, at, values.end());
    sorted = at;
    return elementary::log(*at);
  };
  const double p50 = quantile(.5), p90 = quantile(.9), p99 = quantile(.99);
  return {p50, p90, p99, quantile(1)};
}

} // namespace

Statistics measure(std::span<const Vertex<2>> vertices, std::span<const Cell<2>> cells,
                   std::span<const Neighbours<2>> neighbours, int threads) {
  const auto vertex = [&](Index v) -> const Vertex<2> & { return vertices[v]; };
  const Sums all = summed(cells.size(), threads, [&](Sums &sums, std::size_t c) {
    const Cell<2> &cell = cells[c];
    sums.add_cell(quality(vertex(cell[0]), vertex(cell[1]), vertex(cell[2])));
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfFacet other = neighbours[c][i];
      if (other.exists() && std::cmp_less(other.cell(), c))
        continue; // counted from the other side
      const auto [a, b] = facet_of<2>(cell, i);
      sums.add_edge(edge_length(vertex(a), vertex(b)));
    }
  });
  return statistics_of(all, cells.size());
}

Statistics measure(std::span<const Vertex<3>> vertices, std::span<const Cell<3>> cells,
                   std::span<const std::array<Index, 2>> edges, int threads) {
  const auto vertex = [&](Index v) -> const Vertex<3> & { return vertices[v]; };
  Sums all = summed(cells.size(), threads, [&](Sums &sums, std::size_t c) {
    const Cell<3> &cell = cells[c];
    sums.add_cell(
        quality(vertex(cell[0]), vertex(cell[1]), vertex(cell[2]), vertex(cell[3])));
  });
  all += summed(edges.size(), threads, [&](Sums &sums, std::size_t e) {
    sums.add_edge(edge_length(vertex(edges[e][0]), vertex(edges[e][1])));
  });
  return statistics_of(all, cells.size());
}

double distortion(const SymmetricTensor<2> &M, const SymmetricTensor<2> &N) {
  const double det = determinant<2>(M);
  // trace and determinant of M^-1 N; its eigenvalues are positive
  const double trace =
      (M(1, 1) * N(0, 0) - 2 * M(0, 1) * N(0, 1) + M(0, 0) * N(1, 1)) / det;
  const double product = determinant<2>(N) / det;
  const double large =
      .5 * trace + std::sqrt(std::max(0., .25 * trace * trace - product));
  return std::sqrt(std::max(large, large / product));
}

double distortion(const SymmetricTensor<3> &M, const SymmetricTensor<3> &N) {
  // the largest eigenvalue of N in M; a closed form loses digits of the others only
  const auto stretch = [](const SymmetricTensor<3> &A, const SymmetricTensor<3> &B) {
    return detail::close_eigenvalues(congruent<3>(lower_factor(A), B))[0];
  };
  return std::sqrt(std::max({1., stretch(M, N), stretch(N, M)}));
}

DistortionQuantiles distortion_quantiles(std::span<const Vertex<2>> vertices,
                                         std::span<const Cell<2>> cells, int threads) {
  std::vector<double> values(3 * cells.size());
  parallel_ranges(cells.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [a, b] = facet_of<2>(cells[c], i); // interior edges count twice
        values[3 * c + i] = distortion(vertices[a].M, vertices[b].M);
      }
  });
  return quantiles(std::move(values));
}

DistortionQuantiles distortion_quantiles(std::span<const Vertex<3>> vertices,
                                         std::span<const std::array<Index, 2>> edges,
                                         int threads) {
  std::vector<double> values(edges.size());
  parallel_ranges(edges.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e)
      values[e] = distortion(vertices[edges[e][0]].M, vertices[edges[e][1]].M);
  });
  return quantiles(std::move(values));
}

DistortionQuantiles distortion_quantiles(std::span<const Vertex<3>> vertices,
                                         std::span<const Cell<3>> cells, int threads) {
  return distortion_quantiles(vertices, edges_of<3>(cells, vertices.size()), threads);
}

} // namespace anistar
