#include "mesh/vertex_graph.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace anistar {
namespace {

using Index = std::int32_t;
using Pair = std::pair<Index, Index>;

/// A facet seen from one of its cells: its vertices but the smallest, and the apex.
struct Facet {
  std::array<Index, 2> others;
  Index apex;
  friend bool operator<(const Facet &a, const Facet &b) { return a.others < b.others; }
};

std::size_t at(Index v) { return static_cast<std::size_t>(v); }

void check_size(std::size_t entries) {
  if (entries > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw std::length_error("the mesh is too large for its vertex graph");
}

class WideGraph {
public:
  WideGraph(std::span<const Index> cells, std::size_t corners, std::size_t n_points)
      : cells_(cells), corners_(corners), n_points_(n_points) {}

  VertexGraph build() && {
    collect_pairs();
    return graph();
  }

private:
  /// All pairs to join, found at the smallest vertex of each edge and facet. A pair may
  /// come twice.
  void collect_pairs() {
    std::vector<std::size_t> starts(n_points_ + 1, 0);
    for (const Index v : cells_)
      ++starts[at(v) + 1];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<std::size_t> around(cells_.size()), next(starts.begin(), starts.end());
    for (std::size_t k = 0; k < cells_.size(); ++k)
      around[next[at(cells_[k])]++] = k / corners_;
    for (std::size_t v = 0; v < n_points_; ++v)
      collect_at(static_cast<Index>(v),
                 {around.begin() + std::ptrdiff_t(starts[v]),
                  around.begin() + std::ptrdiff_t(starts[v + 1])});
  }

  void collect_at(Index v, std::span<const std::size_t> cells) {
    larger_.clear();
    facets_.clear();
    for (const std::size_t c : cells) {
      const auto cell = cells_.subspan(c * corners_, corners_);
      for (const Index w : cell)
        if (w > v)
          larger_.push_back(w);
      for (const Index apex : cell)
        if (apex != v)
          add_facet(v, cell, apex);
    }
    std::sort(larger_.begin(), larger_.end());
    larger_.erase(std::unique(larger_.begin(), larger_.end()), larger_.end());
    for (const Index w : larger_)
      pairs_.emplace_back(v, w);
    std::sort(facets_.begin(), facets_.end());
    for (std::size_t k = 1; k < facets_.size(); ++k)
      if (facets_[k - 1].others == facets_[k].others)
        pairs_.emplace_back(facets_[k - 1].apex, facets_[k].apex);
  }

  /// Adds the facet of `cell` that has no `apex`, if `v` is its smallest vertex.
  void add_facet(Index v, std::span<const Index> cell, Index apex) {
    Facet facet{{-1, -1}, apex};
    std::size_t found = 0;
    for (const Index w : cell) {
      if (w == v || w == apex)
        continue;
      if (w < v)
        return;
      facet.others[found++] = w;
    }
    if (found == 2 && facet.others[1] < facet.others[0])
      std::swap(facet.others[0], facet.others[1]);
    facets_.push_back(facet);
  }

  VertexGraph graph() {
    check_size(2 * pairs_.size());
    std::vector<std::size_t> starts(n_points_ + 1, 0);
    for (const auto &[a, b] : pairs_) {
      ++starts[at(a) + 1];
      ++starts[at(b) + 1];
    }
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    VertexGraph out;
    out.neighbours.resize(2 * pairs_.size());
    std::vector<std::size_t> next(starts.begin(), starts.end());
    for (const auto &[a, b] : pairs_) {
      out.neighbours[next[at(a)]++] = b;
      out.neighbours[next[at(b)]++] = a;
    }
    out.offsets.push_back(0);
    auto end = out.neighbours.begin();
    for (std::size_t v = 0; v < n_points_; ++v) {
      const auto first = out.neighbours.begin() + std::ptrdiff_t(starts[v]);
      const auto last = out.neighbours.begin() + std::ptrdiff_t(starts[v + 1]);
      std::sort(first, last);
      end = std::copy(first, std::unique(first, last), end);
      out.offsets.push_back(static_cast<Index>(end - out.neighbours.begin()));
    }
    out.neighbours.erase(end, out.neighbours.end());
    return out;
  }

  std::span<const Index> cells_;
  std::size_t corners_, n_points_;
  std::vector<Index> larger_;
  std::vector<Facet> facets_;
  std::vector<Pair> pairs_;
};

} // namespace

VertexGraph wide_graph(std::span<const std::int32_t> cells, std::size_t corners,
                       std::size_t n_points) {
  return WideGraph(cells, corners, n_points).build();
}

} // namespace anistar
