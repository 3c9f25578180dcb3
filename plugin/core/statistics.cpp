#include "statistics.h"

namespace anistar {

Statistics measure(std::span<const Vertex<2>> vertices,
                   std::span<const Cell<2>> cells) {
  Statistics out;
  const std::span bins(Statistics::length_bins);
  out.length_histogram.assign(bins.size() + 1, 0);
  out.quality_histogram.assign(Statistics::n_quality_bins, 0);
  const auto vertex = [&](Index v) -> const Vertex<2> & {
    return vertices[static_cast<std::size_t>(v)];
  };
  const auto neighbours = adjacency<2>(cells, vertices.size());
  double length_sum = 0, quality_sum = 0;
  std::size_t unit = 0;
  out.length_min = out.quality_min = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const Cell<2> &cell = cells[c];
    const double q = quality(vertex(cell[0]), vertex(cell[1]), vertex(cell[2]));
    quality_sum += q;
    out.quality_min = std::min(out.quality_min, q);
    const double bin = std::clamp(q, 0., 1.) * Statistics::n_quality_bins;
    ++out.quality_histogram[std::min(Statistics::n_quality_bins - 1,
                                     static_cast<std::size_t>(bin))];
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfFacet other = neighbours[c][i];
      if (other.exists() && static_cast<std::size_t>(other.cell()) < c)
        continue; // counted from the other side
      const auto [a, b] = facet_of<2>(cell, i);
      const double l = edge_length(vertex(a), vertex(b));
      ++out.n_edges;
      length_sum += l;
      out.length_min = std::min(out.length_min, l);
      out.length_max = std::max(out.length_max, l);
      unit += l >= shortest_unit && l <= longest_unit;
      ++out.length_histogram[static_cast<std::size_t>(
          std::upper_bound(bins.begin(), bins.end(), l) - bins.begin())];
    }
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

DistortionQuantiles distortion_quantiles(std::span<const Vertex<2>> vertices,
                                         std::span<const Cell<2>> cells) {
  std::vector<double> values;
  values.reserve(3 * cells.size());
  for (const Cell<2> &cell : cells)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = facet_of<2>(cell, i); // interior edges count twice
      values.push_back(std::log(distortion(vertices[static_cast<std::size_t>(a)].M,
                                           vertices[static_cast<std::size_t>(b)].M)));
    }
  const auto quantile = [&](double q) {
    const auto k = static_cast<std::ptrdiff_t>(q * double(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + k, values.end());
    return values[static_cast<std::size_t>(k)];
  };
  if (values.empty())
    return {};
  return {quantile(.5), quantile(.9), quantile(.99), quantile(1)};
}

} // namespace anistar
