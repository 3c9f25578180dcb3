#include "generate/checking/borders.h"

#include "mesh/disjoint_sets.h"
#include "search/box_tree.h"

#include <algorithm>

namespace anistar::generate {
namespace {

/// The edges of triangles, each once, with what they belong to.
class EdgeTable {
public:
  explicit EdgeTable(std::span<const Piece> triangles)
      : edges_of_(triangles.size(), std::array<Index, 3>{}) {
    struct Side {
      Segment ends;
      Index triangle;
      std::size_t local;
    };
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [a, b] = triangles[t].edge(k);
        sides.push_back({{std::min(a, b), std::max(a, b)}, static_cast<Index>(t), k});
      }
    std::stable_sort(sides.begin(), sides.end(),
                     [](const Side &a, const Side &b) { return a.ends < b.ends; });
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (i == 0 || sides[i].ends != sides[i - 1].ends) {
        ends_.push_back(sides[i].ends);
        begin_.push_back(i);
      }
      edges_of_[sides[i].triangle][sides[i].local] =
          static_cast<Index>(ends_.size() - 1);
      triangles_.push_back(sides[i].triangle);
    }
    begin_.push_back(sides.size());
  }

  [[nodiscard]] std::size_t size() const { return ends_.size(); }
  [[nodiscard]] const Segment &ends(std::size_t e) const { return ends_[e]; }
  [[nodiscard]] std::span<const Index> triangles(std::size_t e) const {
    return {triangles_.data() + begin_[e], begin_[e + 1] - begin_[e]};
  }
  [[nodiscard]] const std::array<Index, 3> &edges_of(Index triangle) const {
    return edges_of_[triangle];
  }

private:
  std::vector<std::array<Index, 3>> edges_of_;
  std::vector<Segment> ends_;
  std::vector<std::size_t> begin_;
  std::vector<Index> triangles_;
};

/// Whether each triangle remains when those with an edge of their own are taken away.
std::vector<bool> closed_part(const EdgeTable &table, std::size_t n_triangles) {
  std::vector<bool> remains(n_triangles, true);
  std::vector<std::size_t> count(table.size());
  std::vector<Index> open;
  for (std::size_t e = 0; e < table.size(); ++e) {
    count[e] = table.triangles(e).size();
    if (count[e] == 1)
      open.push_back(static_cast<Index>(e));
  }
  while (
      !open.empty()) { // ends: every round takes a triangle, or an edge from the list
    const Index e = open.back();
    open.pop_back();
    for (const Index t : table.triangles(e)) {
      if (!remains[t])
        continue;
      remains[t] = false;
      for (const Index f : table.edges_of(t))
        if (--count[f] == 1)
          open.push_back(f);
    }
  }
  return remains;
}

/// Chains of edges, each as long as it goes.
std::vector<std::vector<Index>> chains_of(const std::vector<Segment> &edges) {
  std::vector<std::array<Index, 2>> ends; // point, edge
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (const Index v : edges[e])
      ends.push_back({v, static_cast<Index>(e)});
  std::sort(ends.begin(), ends.end());
  std::vector<bool> is_taken(edges.size(), false);
  const auto next = [&](Index v) {
    const auto begin =
        std::lower_bound(ends.begin(), ends.end(), std::array{v, Index{0}});
    for (auto it = begin; it != ends.end() && (*it)[0] == v; ++it)
      if (!is_taken[(*it)[1]])
        return (*it)[1];
    return none;
  };
  const auto follow = [&](std::vector<Index> &chain) {
    for (Index e = next(chain.back()); e != none; e = next(chain.back())) {
      is_taken[e] = true;
      chain.push_back(edges[e][0] == chain.back() ? edges[e][1] : edges[e][0]);
      if (chain.back() == chain.front())
        return;
    }
  };
  std::vector<std::vector<Index>> chains;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (is_taken[e])
      continue;
    is_taken[e] = true;
    std::vector<Index> chain{edges[e][0], edges[e][1]};
    follow(chain);
    if (chain.back() != chain.front()) { // and from its start the other way
      std::reverse(chain.begin(), chain.end());
      follow(chain);
    }
    chains.push_back(std::move(chain));
  }
  return chains;
}

/// Which parts of a surface something can be inside of.
class Closedness {
public:
  Closedness(std::span<const Vector<3>> points, std::span<const Piece> triangles,
             const EdgeTable &table)
      : parts_(points.size()), boxes_(points.size()), is_closed_(points.size(), false) {
    const std::vector<bool> remains = closed_part(table, triangles.size());
    for (const Piece &t : triangles) {
      parts_.join(t.corners[0], t.corners[1]);
      parts_.join(t.corners[0], t.corners[2]);
    }
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const std::size_t part = parts_.root(triangles[t].corners[0]);
      if (remains[t])
        is_closed_[part] = true;
      for (const Index v : triangles[t].points())
        boxes_[part].extend(points[v]);
    }
    for (std::size_t part = 0; part < is_closed_.size(); ++part)
      if (is_closed_[part])
        closed_.push_back(part);
  }

  [[nodiscard]] bool is_open(Index point) {
    const std::size_t part = parts_.root(point);
    if (is_closed_[part])
      return false;
    const Box<3> &box = boxes_[part];
    return std::none_of(closed_.begin(), closed_.end(), [&](std::size_t other) {
      return (boxes_[other].low.array() <= box.low.array()).all() &&
             (boxes_[other].high.array() >= box.high.array()).all();
    });
  }

private:
  DisjointSets parts_;
  std::vector<Box<3>> boxes_;
  std::vector<bool> is_closed_;
  std::vector<std::size_t> closed_;
};

double length_of(std::span<const Vector<3>> points, const std::vector<Index> &chain) {
  double length = 0;
  for (std::size_t k = 1; k < chain.size(); ++k)
    length += (points[chain[k]] - points[chain[k - 1]]).norm();
  return length;
}

} // namespace

Borders borders_of(std::span<const Vector<3>> points,
                   std::span<const Piece> triangles) {
  const EdgeTable table(triangles);
  Borders out;
  std::vector<Segment> open;
  for (std::size_t e = 0; e < table.size(); ++e) {
    const std::size_t n = table.triangles(e).size();
    if (n == 1)
      open.push_back(table.ends(e));
    if (n > 2)
      out.crowded.push_back({table.ends(e), n});
  }
  if (open.empty())
    return out;
  Closedness closedness(points, triangles, table);
  for (std::vector<Index> &chain : chains_of(open)) {
    const double length = length_of(points, chain);
    const bool is_open = closedness.is_open(chain.front());
    out.borders.push_back({std::move(chain), length, is_open});
  }
  return out;
}

} // namespace anistar::generate
