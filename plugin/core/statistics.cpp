#include "statistics.h"

namespace anistar {
namespace {

/// The edges of the cells, each once, as pairs of indices in increasing order.
template <std::size_t d>
std::vector<std::array<Index, 2>> edges_of(std::span<const Cell<d>> cells,
                                           std::size_t n_vertices) {
  // a counting sort by the lower end, then a sort of every bucket
  std::vector<std::size_t> start(n_vertices + 1, 0);
  const auto each = [&](auto visit) {
    for (const Cell<d> &cell : cells)
      for (std::size_t i = 0; i <= d; ++i)
        for (std::size_t j = i + 1; j <= d; ++j)
          visit(static_cast<std::size_t>(std::min(cell[i], cell[j])),
                std::max(cell[i], cell[j]));
  };
  each([&](std::size_t low, Index) { ++start[low + 1]; });
  for (std::size_t v = 0; v < n_vertices; ++v)
    start[v + 1] += start[v];
  std::vector<Index> high(start.back());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  each([&](std::size_t low, Index other) { high[next[low]++] = other; });
  std::vector<std::array<Index, 2>> edges;
  for (std::size_t v = 0; v < n_vertices; ++v) {
    const auto begin = high.begin() + static_cast<std::ptrdiff_t>(start[v]),
               end = high.begin() + static_cast<std::ptrdiff_t>(start[v + 1]);
    std::sort(begin, end);
    const auto last = std::unique(begin, end);
    for (auto it = begin; it != last; ++it)
      edges.push_back({static_cast<Index>(v), *it});
  }
  return edges;
}

} // namespace

template <std::size_t d>
Statistics measure(std::span<const Vertex<d>> vertices,
                   std::span<const Cell<d>> cells) {
  Statistics out;
  const std::span bins(Statistics::length_bins);
  out.length_histogram.assign(bins.size() + 1, 0);
  out.quality_histogram.assign(Statistics::n_quality_bins, 0);
  const auto vertex = [&](Index v) -> const Vertex<d> & {
    return vertices[static_cast<std::size_t>(v)];
  };
  double length_sum = 0, quality_sum = 0;
  std::size_t unit = 0;
  out.length_min = out.quality_min = std::numeric_limits<double>::infinity();
  for (const Cell<d> &cell : cells) {
    const double q = [&] {
      if constexpr (d == 2)
        return quality(vertex(cell[0]), vertex(cell[1]), vertex(cell[2]));
      else
        return quality(vertex(cell[0]), vertex(cell[1]), vertex(cell[2]),
                       vertex(cell[3]));
    }();
    quality_sum += q;
    out.quality_min = std::min(out.quality_min, q);
    const double bin = std::clamp(q, 0., 1.) * Statistics::n_quality_bins;
    ++out.quality_histogram[std::min(Statistics::n_quality_bins - 1,
                                     static_cast<std::size_t>(bin))];
  }
  for (const auto &[a, b] : edges_of<d>(cells, vertices.size())) {
    const double l = edge_length(vertex(a), vertex(b));
    ++out.n_edges;
    length_sum += l;
    out.length_min = std::min(out.length_min, l);
    out.length_max = std::max(out.length_max, l);
    unit += l >= shortest_unit && l <= longest_unit;
    ++out.length_histogram[static_cast<std::size_t>(
        std::upper_bound(bins.begin(), bins.end(), l) - bins.begin())];
  }
  const double n_edges = static_cast<double>(std::max<std::size_t>(out.n_edges, 1));
  out.unit_fraction = static_cast<double>(unit) / n_edges;
  out.length_mean = length_sum / n_edges;
  out.quality_mean =
      quality_sum / static_cast<double>(std::max<std::size_t>(cells.size(), 1));
  return out;
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
    Eigen::SelfAdjointEigenSolver<Matrix<3>> solver;
    solver.computeDirect(as_matrix(congruent<3>(lower_factor(A), B)),
                         Eigen::EigenvaluesOnly);
    return solver.eigenvalues()[2];
  };
  return std::sqrt(std::max({1., stretch(M, N), stretch(N, M)}));
}

template <std::size_t d>
DistortionQuantiles distortion_quantiles(std::span<const Vertex<d>> vertices,
                                         std::span<const Cell<d>> cells) {
  std::vector<double> values;
  values.reserve((d + 1) * cells.size());
  for (const auto &[a, b] : edges_of<d>(cells, vertices.size()))
    values.push_back(std::log(distortion(vertices[static_cast<std::size_t>(a)].M,
                                         vertices[static_cast<std::size_t>(b)].M)));
  const auto quantile = [&](double q) {
    const auto k = static_cast<std::ptrdiff_t>(q * double(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + k, values.end());
    return values[static_cast<std::size_t>(k)];
  };
  if (values.empty())
    return {};
  return {quantile(.5), quantile(.9), quantile(.99), quantile(1)};
}

template Statistics measure<2>(std::span<const Vertex<2>>, std::span<const Cell<2>>);
template Statistics measure<3>(std::span<const Vertex<3>>, std::span<const Cell<3>>);
template DistortionQuantiles distortion_quantiles<2>(std::span<const Vertex<2>>,
                                                     std::span<const Cell<2>>);
template DistortionQuantiles distortion_quantiles<3>(std::span<const Vertex<3>>,
                                                     std::span<const Cell<3>>);

} // namespace anistar
