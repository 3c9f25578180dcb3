#include "generate/facets/surface_loops.h"

#include "generate/facets/facet_plane.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace anistar::generate {
namespace {

using Loop = std::vector<Index>;

/// A side of a triangle of the facet.
struct Side {
  Index low, high;
  bool is_rising; ///< the triangle goes along it from low to high

  [[nodiscard]] auto ends() const { return std::tie(low, high); }
};

/// The sides of an odd number of triangles.
std::vector<Side> border_of(std::vector<Side> sides) {
  std::sort(sides.begin(), sides.end(),
            [](const Side &s, const Side &t) { return s.ends() < t.ends(); });
  std::vector<Side> border;
  for (std::size_t p = 0, q = 0; p < sides.size(); p = q) {
    while (q < sides.size() && sides[q].ends() == sides[p].ends())
      ++q;
    if ((q - p) % 2 == 1)
      border.push_back(sides[p]);
  }
  return border;
}

/// Follows the sides of a border, each once, whatever their direction: an even number
/// of them meet at every point.
class Chains {
public:
  explicit Chains(const std::vector<Side> &border) : is_used_(border.size(), false) {
    for (std::size_t k = 0; k < border.size(); ++k) {
      const auto &[low, high, is_rising] = border[k];
      // along its triangle first, so that loops set out in that direction
      ways_.push_back({low, !is_rising, high, k});
      ways_.push_back({high, is_rising, low, k});
    }
    std::sort(ways_.begin(), ways_.end());
  }

  /// Loops that visit no point twice.
  std::vector<Loop> loops() {
    std::vector<Loop> found;
    for (const Way &way : ways_) {
      Loop path{way.from};
      std::map<Index, std::ptrdiff_t> place{{way.from, 0}}; // on the path
      while (const Way *onward = unused_from(path.back())) {
        is_used_[onward->side] = true;
        const auto [at, is_new] =
            place.emplace(onward->to, static_cast<std::ptrdiff_t>(path.size()));
        if (is_new) {
          path.push_back(onward->to);
          continue;
        }
        const auto before = path.begin() + at->second;
        found.emplace_back(before, path.end());
        std::for_each(before + 1, path.end(), [&](Index v) { place.erase(v); });
        path.erase(before + 1, path.end());
      }
    }
    return found;
  }

private:
  struct Way {
    Index from;
    bool is_against;
    Index to;
    std::size_t side;
    friend auto operator<=>(const Way &, const Way &) = default;
  };
  std::vector<Way> ways_;
  std::vector<bool> is_used_;

  [[nodiscard]] const Way *unused_from(Index point) const {
    auto way = std::lower_bound(ways_.begin(), ways_.end(), point,
                                [](const Way &w, Index v) { return w.from < v; });
    for (; way != ways_.end() && way->from == point; ++way)
      if (!is_used_[way->side])
        return &*way;
    return nullptr;
  }
};

class FacetOfTriangles {
public:
  explicit FacetOfTriangles(std::span<const Vector<3>> points) : points_(points) {}

  std::vector<Loop> loops(std::span<const Facet<3>> triangles,
                          std::span<const Index> own) const {
    if (own.size() == 1)
      return {Loop(triangles[own[0]].begin(), triangles[own[0]].end())};
    std::vector<Side> sides;
    Loop inner;
    for (const Index t : own)
      for (std::size_t i = 0; i < 3; ++i) {
        const Index a = triangles[t][i], b = triangles[t][(i + 1) % 3];
        sides.push_back({std::min(a, b), std::max(a, b), a < b});
        inner.push_back(a);
      }
    const std::vector<Side> border = border_of(std::move(sides));
    std::vector<Loop> all = Chains(border).loops();
    std::vector<double> area;
    for (const Loop &loop : all)
      area.push_back(FacetPlane::of(points_, loop).normal.squaredNorm());
    if (!all.empty())
      std::iter_swap(all.begin(),
                     all.begin() +
                         (std::max_element(area.begin(), area.end()) - area.begin()));
    for (const Index v : without(std::move(inner), border))
      all.push_back({v});
    return all;
  }

private:
  std::span<const Vector<3>> points_;

  static Loop without(Loop points, const std::vector<Side> &border) {
    Loop at_border;
    for (const Side &side : border)
      at_border.insert(at_border.end(), {side.low, side.high});
    std::sort(at_border.begin(), at_border.end());
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    std::erase_if(points, [&](Index v) {
      return std::binary_search(at_border.begin(), at_border.end(), v);
    });
    return points;
  }
};

} // namespace

SurfaceLoops surface_loops(std::span<const Vector<3>> points,
                           std::span<const Facet<3>> triangles,
                           std::span<const Index> owners, std::size_t n_facets) {
  std::vector<Index> order(triangles.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Index s, Index t) { return owners[s] < owners[t]; });
  SurfaceLoops out;
  const FacetOfTriangles facet(points);
  auto start = order.begin();
  for (std::size_t f = 0; f < n_facets; ++f) {
    const auto end = std::find_if(
        start, order.end(), [&](Index t) { return std::cmp_not_equal(owners[t], f); });
    for (const Loop &loop : facet.loops(triangles, {start, end})) {
      out.indices.insert(out.indices.end(), loop.begin(), loop.end());
      out.loop_starts.push_back(static_cast<std::int64_t>(out.indices.size()));
    }
    out.facet_starts.push_back(static_cast<std::int64_t>(out.loop_starts.size()) - 1);
    start = end;
  }
  return out;
}

} // namespace anistar::generate
