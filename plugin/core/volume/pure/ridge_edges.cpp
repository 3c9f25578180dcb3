#include "volume/pure/ridge_edges.h"

#include <algorithm>

namespace anistar {

RidgeEdges::RidgeEdges(std::vector<RidgeEdge> edges) : edges_(std::move(edges)) {
  for (std::size_t e = 0; e < edges_.size(); ++e)
    link(static_cast<Index>(e));
}

void RidgeEdges::link(Index edge) {
  for (Index v : edges_[edge].ends) {
    if (std::cmp_greater_equal(v, at_.size()))
      at_.resize(v + 1);
    at_[v].push_back(edge);
  }
}

Index RidgeEdges::missing(const StarSet &stars, Index v) const {
  if (std::cmp_greater_equal(v, at_.size()))
    return none;
  const auto &corners = stars.star(v).corners();
  for (Index e : at_[v]) {
    const auto &ends = edges_[e].ends;
    const Index w = ends[ends[0] == v ? 1 : 0];
    if (std::none_of(corners.begin(), corners.end(),
                     [&](const Star::Seen &corner) { return corner.site == w; }))
      return e;
  }
  return none;
}

Index RidgeEdges::encroached(const StarSet &stars, const Vector<3> &x) const {
  Index found = none;
  double deepest = 0;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const Vertex<3> &a = stars.site(edges_[e].ends[0]).vertex,
                    &b = stars.site(edges_[e].ends[1]).vertex;
    const Vector<3> u = x - a.x, v = x - b.x, length = b.x - a.x;
    for (const SymmetricTensor<3> *M : {&a.M, &b.M}) {
      // the angle at x is obtuse
      const double power = u.dot(product<3>(*M, v)) / quadratic<3>(*M, length);
      if (power < deepest) {
        deepest = power;
        found = static_cast<Index>(e);
      }
    }
  }
  return found;
}

void RidgeEdges::split(Index edge, Index v) {
  const RidgeEdge old = edges_[edge];
  std::erase(at_[old.ends[1]], edge);
  edges_[edge].ends[1] = v;
  if (std::cmp_greater_equal(v, at_.size()))
    at_.resize(v + 1);
  at_[v].push_back(edge);
  edges_.push_back({{v, old.ends[1]}, old.curve, {none, none}});
  link(static_cast<Index>(edges_.size()) - 1);
}

} // namespace anistar
