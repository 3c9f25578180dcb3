#include "refine.h"

#include <cmath>

namespace anistar {
namespace {

/// Circumradius above which a cell is refined. A unit equilateral triangle has
/// 1/sqrt 3 = .577; with this value the edges of the result have mean length one.
constexpr double largest_radius = .78;
/// Smallest metric distance between a new vertex and those around it.
constexpr double separation = .6;
/// Constrained edges shorter than this are not split by refinement.
constexpr double shortest_split = 1.3;
/// Nearer than this to a longer edge that cannot be split, nothing is inserted.
constexpr double least_height = .5;
/// A cell this much larger than the target whose circumcentre is hidden behind a
/// constraint is refined at its centroid.
constexpr double hidden_radius = 3 * largest_radius;
constexpr int flip_cap = 200;
/// Radii are sorted into buckets, four to a factor of two.
constexpr std::size_t n_buckets = 64;

/// The mean of three metrics, whose density is their geometric mean.
SymmetricTensor<2> mean_metric(const Vertex<2> &a, const Vertex<2> &b,
                               const Vertex<2> &c) {
  SymmetricTensor<2> M = a.weight * a.M + b.weight * b.M + c.weight * c.M;
  const double density = 1 / std::cbrt(a.weight * b.weight * c.weight);
  return M *= density / std::sqrt(determinant<2>(M));
}

class Refinement {
public:
  Refinement(Workspace &w, Legaliser &legaliser, Monitor &monitor)
      : w_(w), legaliser_(legaliser), monitor_(monitor) {}

  RefineCounts run() {
    for (std::size_t c = 0; c < w_.mesh.cells.size(); ++c)
      push(static_cast<Index>(c));
    Index cell = none;
    while ((cell = pop()) != none && monitor_.keep_going(w_.mesh.vertices.size(), 0))
      treat(cell);
    return counts_;
  }

private:
  struct Entry { ///< a cell as it was when pushed
    Index cell;
    Cell<2> vertices;
  };

  Workspace &w_;
  Legaliser &legaliser_;
  Monitor &monitor_;
  RefineCounts counts_;
  std::array<std::vector<Entry>, n_buckets> buckets_;
  std::array<std::size_t, n_buckets> head_{};
  std::size_t top_ = 0; ///< no bucket above this one has entries
  std::vector<Index> changed_;

  [[nodiscard]] Circumcircle circle_of(Index cell) const {
    const Cell<2> &v = w_.mesh.at(cell);
    const Vertex<2> &a = w_.mesh.vertex(v[0]), &b = w_.mesh.vertex(v[1]),
                    &c = w_.mesh.vertex(v[2]);
    return circumcircle(mean_metric(a, b, c), a.x, b.x, c.x);
  }

  void push(Index cell) {
    if (!w_.mesh.is_alive(cell))
      return;
    const double radius = circle_of(cell).radius;
    if (!(radius > largest_radius)) // also when round-off has made it NaN
      return;
    const double level = 4 * std::log2(radius / largest_radius);
    const std::size_t b = std::min(n_buckets - 1, static_cast<std::size_t>(level));
    buckets_[b].push_back({cell, w_.mesh.at(cell)});
    top_ = std::max(top_, b);
  }

  Index pop() {
    for (;;) {
      std::vector<Entry> &bucket = buckets_[top_];
      std::size_t &head = head_[top_];
      while (head < bucket.size()) {
        const Entry entry = bucket[head++];
        if (w_.mesh.at(entry.cell) == entry.vertices)
          return entry.cell;
      }
      bucket.clear();
      head = 0;
      if (top_ == 0)
        return none;
      --top_;
    }
  }

  /// Legalises around the last cavity and queues what changed.
  void settle() {
    changed_.clear();
    for (HalfFacet h : w_.cavity.star()) {
      changed_.push_back(h.cell());
      legaliser_.push(h);
    }
    legaliser_.run(flip_cap, &changed_);
    for (Index c : changed_)
      push(c);
  }

  bool split(HalfFacet wall) {
    if (w_.length(wall) < shortest_split || split_edge(w_, wall) == none)
      return false;
    ++counts_.boundary_splits;
    settle();
    return true;
  }

  void treat(Index cell) {
    const Cell<2> before = w_.mesh.at(cell);
    const Circumcircle circle = circle_of(cell);
    if (!circle.centre.allFinite())
      return;
    const Walk at = walk_to(w_.mesh, cell, circle.centre);
    Offer answer = Offer::walled;
    if (at.cell != none)
      answer = offer(circle.centre, at.cell);
    else if (at.wall.exists() && split(at.wall))
      answer = Offer::split;
    else if (circle.radius < hidden_radius)
      answer = Offer::refused;
    if (answer == Offer::walled) {
      const Simplex<2> s = w_.mesh.simplex(cell);
      answer = offer((s[0] + s[1] + s[2]) / 3, cell);
    }
    switch (answer) {
    case Offer::taken:
      ++counts_.inserted;
      settle();
      break;
    case Offer::split:
      again(cell, before);
      break;
    case Offer::walled:
    case Offer::refused:
      ++counts_.rejected;
    }
  }

  enum class Offer {
    taken,
    split,  ///< a constrained edge instead
    walled, ///< too near to a long edge that cannot be split
    refused
  };

  /// Offers x to the cell that contains it.
  Offer offer(const Vector<2> &x, Index cell) {
    Index hint = w_.mesh.background_cell[static_cast<std::size_t>(w_.mesh.at(cell)[0])];
    const Vertex<2> vertex = w_.background.vertex(x, hint);
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfFacet edge(cell, i);
      if (!encroaches(vertex, edge))
        continue;
      if (w_.length(edge) < shortest_split)
        return Offer::refused;
      if (split(edge))
        return Offer::split;
      if (height(vertex, edge) < least_height)
        return Offer::walled;
    }
    if (is_crowded(vertex, cell) || insert_in_cell(w_, cell, vertex, hint) == none)
      return Offer::refused;
    return Offer::taken;
  }

  void again(Index cell, const Cell<2> &before) {
    if (w_.mesh.at(cell) == before)
      push(cell);
  }

  /// x lies inside the diametral ellipse, in its own metric, of a constrained edge.
  [[nodiscard]] bool encroaches(const Vertex<2> &p, HalfFacet edge) const {
    if (w_.mesh.constraint(edge) == none)
      return false;
    const auto [a, b] = w_.mesh.facet(edge);
    const Vector<2> u = w_.mesh.vertex(a).x - p.x, v = w_.mesh.vertex(b).x - p.x;
    return product<2>(p.M, u).dot(v) < 0;
  }

  /// Distance of p from the line of an edge in its own metric.
  [[nodiscard]] double height(const Vertex<2> &p, HalfFacet edge) const {
    const auto [ia, ib] = w_.mesh.facet(edge);
    const Vector<2> &a = w_.mesh.vertex(ia).x, u = w_.mesh.vertex(ib).x - a;
    const double area = std::abs(cross(u, p.x - a)) / p.weight;
    return area / std::sqrt(quadratic<2>(p.M, u));
  }

  [[nodiscard]] bool is_crowded(const Vertex<2> &p, Index cell) const {
    const auto near = [&](Index v) {
      const Vertex<2> &q = w_.mesh.vertex(v);
      const Vector<2> r = q.x - p.x;
      return quadratic<2>(p.M, r) < separation * separation ||
             quadratic<2>(q.M, r) < separation * separation;
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfFacet beyond = w_.mesh.opposite(HalfFacet(cell, i));
      if (near(w_.mesh.at(cell)[i]) || (beyond.exists() && near(w_.mesh.apex(beyond))))
        return true;
    }
    return false;
  }
};

} // namespace

RefineCounts refine(Workspace &w, Legaliser &legaliser, Monitor &monitor) {
  return Refinement(w, legaliser, monitor).run();
}

} // namespace anistar
