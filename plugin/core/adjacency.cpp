#include "adjacency.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace anistar {

template <std::size_t d>
std::vector<Neighbours<d>> adjacency(std::span<const Cell<d>> cells,
                                     std::size_t n_points) {
  std::vector<Neighbours<d>> neighbours(cells.size());
  const auto key_of = [&](const HalfFacet &half) {
    Facet<d> key =
        facet_of<d>(cells[static_cast<std::size_t>(half.cell())], half.facet());
    std::sort(key.begin(), key.end());
    return key;
  };
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
  std::vector<HalfFacet> bucket(cells.size() * (d + 1));
  std::vector<Index> fill(start.begin(), start.end() - 1);
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t i = 0; i <= d; ++i) {
      const Facet<d> facet = facet_of<d>(cells[c], i);
      const auto v =
          static_cast<std::size_t>(*std::min_element(facet.begin(), facet.end()));
      bucket[static_cast<std::size_t>(fill[v]++)] = HalfFacet(static_cast<Index>(c), i);
    }
  for (std::size_t v = 0; v < n_points; ++v)
    for (Index p = start[v]; p < start[v + 1]; ++p) {
      const HalfFacet &one = bucket[static_cast<std::size_t>(p)];
      const Facet<d> key = key_of(one);
      for (Index q = p + 1; q < start[v + 1]; ++q) {
        const HalfFacet &two = bucket[static_cast<std::size_t>(q)];
        if (key_of(two) != key)
          continue;
        HalfFacet &side = neighbours[static_cast<std::size_t>(one.cell())][one.facet()];
        HalfFacet &other =
            neighbours[static_cast<std::size_t>(two.cell())][two.facet()];
        if (side.exists() || other.exists())
          throw std::invalid_argument("a facet of cell " + std::to_string(one.cell()) +
                                      " is shared by more than two cells");
        side = two;
        other = one;
      }
    }
  return neighbours;
}

template std::vector<Neighbours<2>> adjacency<2>(std::span<const Cell<2>>, std::size_t);
template std::vector<Neighbours<3>> adjacency<3>(std::span<const Cell<3>>, std::size_t);

} // namespace anistar
