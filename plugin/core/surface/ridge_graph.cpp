#include "surface/ridge_graph.h"

namespace anistar {

void RidgeGraph::add(Index a, Index b, Index curve) {
  Index e = static_cast<Index>(edges_.size());
  if (free_.empty()) {
    edges_.emplace_back();
  } else {
    e = free_.back();
    free_.pop_back();
  }
  Index &head_a = first_[a];
  Index &head_b = first_[b];
  edges_[e] = {{a, b}, curve, {head_a, head_b}};
  head_a = head_b = e;
}

void RidgeGraph::unlink(Index edge, Index v) {
  const auto next_of = [&](Index e) -> Index & {
    RidgeEdge &link = edges_[e];
    return link.next[link.ends[0] == v ? 0 : 1];
  };
  Index *link = &first_[v];
  while (*link != edge)
    link = &next_of(*link);
  *link = next_of(edge);
}

void RidgeGraph::remove(Index edge) {
  const std::array<Index, 2> ends = at(edge).ends;
  unlink(edge, ends[0]);
  unlink(edge, ends[1]);
  edges_[edge] = {};
  free_.push_back(edge);
}

Index RidgeGraph::find(Index a, Index b) const {
  Index found = none;
  around(a, [&](Index edge, Index other) {
    if (other == b)
      found = edge;
  });
  return found;
}

void RidgeGraph::split(Index a, Index b, Index v) {
  const Index edge = find(a, b), curve = at(edge).curve;
  remove(edge);
  add(a, v, curve);
  add(v, b, curve);
}

void RidgeGraph::contract(Index v, Index u) {
  Index beyond = none, far_edge = none;
  around(v, [&](Index edge, Index other) {
    if (other != u) {
      beyond = other;
      far_edge = edge;
    }
  });
  const Index curve = at(far_edge).curve;
  remove(find(v, u));
  remove(far_edge);
  add(u, beyond, curve);
}

void RidgeGraph::renumber(const std::vector<Index> &rank, std::size_t n_vertices) {
  std::vector<RidgeEdge> old = std::move(edges_);
  edges_.clear();
  free_.clear();
  first_.assign(n_vertices, none);
  for (const RidgeEdge &edge : old)
    if (edge.ends[0] != none)
      add(rank[edge.ends[0]], rank[edge.ends[1]], edge.curve);
}

} // namespace anistar
