#include "adjacency.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace anistar {

namespace {

/// A half-facet with its vertices but the lowest, in increasing order.
template <std::size_t d> struct Entry {
  std::array<Index, d - 1> rest;
  HalfFacet half;
};

template <std::size_t d> Facet<d> sorted(Facet<d> facet) {
  std::sort(facet.begin(), facet.end());
  return facet;
}

} // namespace

template <std::size_t d>
std::vector<Neighbours<d>> adjacency(std::span<const Cell<d>> cells,
                                     std::size_t n_points) {
  std::vector<Neighbours<d>> neighbours(cells.size());
  // counting sort of the half-facets by their smallest vertex, then matching in buckets
  std::vector<Index> start(n_points + 1, 0);
  for (const Cell<d> &cell : cells)
    for (std::size_t i = 0; i <= d; ++i) {
      const Facet<d> facet = facet_of<d>(cell, i);
      ++start[static_cast<std::size_t>(*std::min_element(facet.begin(), facet.end())) +
              1];
    }
  for (std::size_t v = 0; v < n_points; ++v)
    start[v + 1] += start[v];
  std::vector<Entry<d>> bucket(cells.size() * (d + 1));
  std::vector<Index> fill(start.begin(), start.end() - 1);
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t i = 0; i <= d; ++i) {
      const Facet<d> facet = sorted<d>(facet_of<d>(cells[c], i));
      Entry<d> &entry =
          bucket[static_cast<std::size_t>(fill[static_cast<std::size_t>(facet[0])]++)];
      std::copy(facet.begin() + 1, facet.end(), entry.rest.begin());
      entry.half = HalfFacet(static_cast<Index>(c), i);
    }
  const auto side_of = [&](HalfFacet half) -> HalfFacet & {
    return neighbours[static_cast<std::size_t>(half.cell())][half.facet()];
  };
  for (std::size_t v = 0; v < n_points; ++v)
    for (Index p = start[v]; p < start[v + 1]; ++p) {
      const Entry<d> &one = bucket[static_cast<std::size_t>(p)];
      for (Index q = p + 1; q < start[v + 1]; ++q) {
        const Entry<d> &two = bucket[static_cast<std::size_t>(q)];
        if (two.rest.front() != one.rest.front() || two.rest.back() != one.rest.back())
          continue;
        HalfFacet &side = side_of(one.half), &other = side_of(two.half);
        if (side.exists() || other.exists())
          throw std::invalid_argument("a facet of cell " +
                                      std::to_string(one.half.cell()) +
                                      " is shared by more than two cells");
        side = two.half;
        other = one.half;
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
