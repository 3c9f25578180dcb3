#include "generate/facets/triangle_sides.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace anistar::generate {

std::vector<SidesOfTriangle> triangle_sides(std::span<const Facet<3>> triangles,
                                            std::size_t n_points) {
  struct Side {
    Index high, triangle;
    std::uint8_t corner;
    bool is_rising;
  };
  // a counting sort by the lower end, then a sort of every bucket
  std::vector<std::size_t> start(n_points + 1, 0);
  const auto ends = [](const Facet<3> &t, std::size_t i) {
    return std::pair{t[(i + 1) % 3], t[(i + 2) % 3]};
  };
  for (const Facet<3> &t : triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = ends(t, i);
      ++start[static_cast<std::size_t>(std::min(a, b)) + 1];
    }
  for (std::size_t v = 0; v < n_points; ++v)
    start[v + 1] += start[v];
  std::vector<Side> sides(3 * triangles.size());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for (std::size_t k = 0; k < triangles.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = ends(triangles[k], i);
      sides[next[static_cast<std::size_t>(std::min(a, b))]++] = {
          std::max(a, b), static_cast<Index>(k), static_cast<std::uint8_t>(i), a < b};
    }
  std::vector<SidesOfTriangle> across(triangles.size());
  for (std::size_t v = 0; v < n_points; ++v) {
    const std::span bucket(sides.begin() + static_cast<std::ptrdiff_t>(start[v]),
                           sides.begin() + static_cast<std::ptrdiff_t>(start[v + 1]));
    std::sort(bucket.begin(), bucket.end(), [](const Side &s, const Side &t) {
      return std::tie(s.high, s.triangle, s.corner) <
             std::tie(t.high, t.triangle, t.corner);
    });
    for (std::size_t p = 0, q = 0; p < bucket.size(); p = q) {
      for (q = p; q < bucket.size() && bucket[q].high == bucket[p].high;)
        ++q;
      if (q - p != 2)
        continue;
      const Side &s = bucket[p], &t = bucket[p + 1];
      const bool is_turned = s.is_rising == t.is_rising;
      across[s.triangle][s.corner] = {t.triangle, t.corner, is_turned};
      across[t.triangle][t.corner] = {s.triangle, s.corner, is_turned};
    }
  }
  return across;
}

} // namespace anistar::generate
