#include "mesh/adjacency.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace anistar {

namespace {

/// The vertices of a facet.
struct FacetKey {
  std::size_t lowest;
  std::uint64_t others; ///< in increasing order, as one number
};

FacetKey key_of(const Facet<2> &facet) {
  const auto [low, high] = std::minmax(facet[0], facet[1]);
  return {static_cast<std::size_t>(low), static_cast<std::uint64_t>(high)};
}

FacetKey key_of(const Facet<3> &facet) {
  const auto [a, b] = std::minmax(facet[0], facet[1]);
  const Index low = std::min(a, facet[2]), high = std::max(b, facet[2]);
  const Index middle = std::max(a, std::min(b, facet[2]));
  return {static_cast<std::size_t>(low),
          static_cast<std::uint64_t>(middle) << 32 | static_cast<std::uint64_t>(high)};
}

/// A half-facet among those with the same lowest vertex.
struct Candidate {
  std::uint64_t others;
  HalfFacet half;
};

} // namespace

template <std::size_t d>
std::vector<Neighbours<d>> adjacency(std::span<const Cell<d>> cells,
                                     std::size_t n_points) {
  std::vector<Neighbours<d>> neighbours(cells.size());
  // counting sort of the half-facets by their smallest vertex, then matching in buckets
  std::vector<Index> start(n_points + 1, 0);
  for (const Cell<d> &cell : cells)
    for (std::size_t i = 0; i <= d; ++i)
      ++start[key_of(facet_of<d>(cell, i)).lowest + 1];
  for (std::size_t v = 0; v < n_points; ++v)
    start[v + 1] += start[v];
  std::vector<Candidate> candidates(cells.size() * (d + 1));
  std::vector<Index> fill(start.begin(), start.end() - 1);
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t i = 0; i <= d; ++i) {
      const FacetKey key = key_of(facet_of<d>(cells[c], i));
      candidates[fill[key.lowest]++] = {key.others,
                                        HalfFacet(static_cast<Index>(c), i)};
    }
  const auto side_of = [&](HalfFacet half) -> HalfFacet & {
    return neighbours[half.cell()][half.facet()];
  };
  for (std::size_t v = 0; v < n_points; ++v) {
    const std::span bucket(candidates.begin() + start[v],
                           candidates.begin() + start[v + 1]);
    for (std::size_t p = 0; p < bucket.size(); ++p)
      for (std::size_t q = p + 1; q < bucket.size(); ++q) {
        if (bucket[p].others != bucket[q].others)
          continue;
        HalfFacet &side = side_of(bucket[p].half), &other = side_of(bucket[q].half);
        if (side.exists() || other.exists())
          throw std::invalid_argument("a facet of cell " +
                                      std::to_string(bucket[p].half.cell()) +
                                      " is shared by more than two cells");
        side = bucket[q].half;
        other = bucket[p].half;
      }
  }
  return neighbours;
}

template <std::size_t d>
std::vector<std::array<Index, 2>> edges_of(std::span<const Cell<d>> cells,
                                           std::size_t n_points) {
  // a counting sort by the lower end, then a sort of every bucket
  std::vector<std::size_t> start(n_points + 1, 0);
  const auto each = [&](auto visit) {
    for (const Cell<d> &cell : cells)
      for (std::size_t i = 0; i <= d; ++i)
        for (std::size_t j = i + 1; j <= d; ++j)
          visit(static_cast<std::size_t>(std::min(cell[i], cell[j])),
                std::max(cell[i], cell[j]));
  };
  each([&](std::size_t low, Index) { ++start[low + 1]; });
  for (std::size_t v = 0; v < n_points; ++v)
    start[v + 1] += start[v];
  std::vector<Index> high(start.back());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  each([&](std::size_t low, Index other) { high[next[low]++] = other; });
  std::vector<std::array<Index, 2>> edges;
  for (std::size_t v = 0; v < n_points; ++v) {
    const auto begin = high.begin() + static_cast<std::ptrdiff_t>(start[v]),
               end = high.begin() + static_cast<std::ptrdiff_t>(start[v + 1]);
    std::sort(begin, end);
    const auto last = std::unique(begin, end);
    for (auto it = begin; it != last; ++it)
      edges.push_back({static_cast<Index>(v), *it});
  }
  return edges;
}

template std::vector<Neighbours<2>> adjacency<2>(std::span<const Cell<2>>, std::size_t);
template std::vector<Neighbours<3>> adjacency<3>(std::span<const Cell<3>>, std::size_t);
template std::vector<std::array<Index, 2>> edges_of<2>(std::span<const Cell<2>>,
                                                       std::size_t);
template std::vector<std::array<Index, 2>> edges_of<3>(std::span<const Cell<3>>,
                                                       std::size_t);

} // namespace anistar
