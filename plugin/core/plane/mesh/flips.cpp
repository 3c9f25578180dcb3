#include "plane/mesh/flips.h"

namespace anistar {

bool bound_swap(const Triangulation<2> &mesh, HalfFacet edge, Cavity &cavity) {
  const HalfFacet other = mesh.opposite(edge);
  if (!other.exists() || mesh.constraint(edge) != none)
    return false;
  const Index apex = mesh.apex(edge);
  cavity.clear();
  cavity.add(edge.cell());
  cavity.add(other.cell());
  cavity.bound(apex);
  return cavity.is_star_shaped(mesh.vertex(apex).x);
}

bool Legaliser::wants_flip(HalfFacet edge) const {
  const HalfFacet other = mesh_.opposite(edge);
  if (!other.exists() || mesh_.constraint(edge) != none ||
      !range_.contains(mesh_.at(edge.cell())) ||
      !range_.contains(mesh_.at(other.cell())))
    return false;
  const auto [ia, ib] = mesh_.facet(edge);
  const Vertex<2> &a = mesh_.vertex(ia), &b = mesh_.vertex(ib);
  const Vertex<2> &c = mesh_.vertex(mesh_.apex(edge)),
                  &e = mesh_.vertex(mesh_.apex(other));
  // summed in pairs, so that both diagonals see the same bits
  const SymmetricTensor<2> blend =
      (a.weight * a.M + b.weight * b.M) + (c.weight * c.M + e.weight * e.M);
  return in_metric_sphere(blend, c.x, a.x, b.x, e.x) == Side::inside;
}

void Legaliser::push_star(Index v) {
  star_of(mesh_, v, star_);
  for (HalfFacet h : star_)
    for (std::size_t i = 0; i < 3; ++i)
      if (i != (h.facet() + 1) % 3) // each spoke once
        stack_.emplace_back(h.cell(), i);
}

void Legaliser::push_finished(Index v, std::span<const HalfFacet> star) {
  for (HalfFacet h : star) {
    const auto [a, b] = mesh_.facet(h);
    if (a > v || b > v)
      continue;
    const HalfFacet spoke(h.cell(), (h.facet() + 2) % 3); // from v to a
    for (HalfFacet edge : {h, spoke})
      if (const HalfFacet beyond = mesh_.opposite(edge);
          beyond.exists() && mesh_.apex(beyond) < v)
        stack_.push_back(edge);
  }
}

void Legaliser::run(int cap, std::vector<Index> *changed) {
  int n = 0;
  while (!stack_.empty()) {
    const HalfFacet edge = stack_.back();
    stack_.pop_back();
    if (!mesh_.is_alive(edge.cell()) || !wants_flip(edge) ||
        !bound_swap(mesh_, edge, cavity_))
      continue;
    if (n++ == cap) {
      ++n_capped_;
      stack_.clear();
      return;
    }
    cavity_.fill(mesh_.apex(edge));
    ++n_flips_;
    for (HalfFacet h : cavity_.star()) {
      for (std::size_t i = 0; i < 3; ++i) {
        const HalfFacet around(h.cell(), i), beyond = mesh_.opposite(around);
        if (beyond.exists() && !cavity_.contains(beyond.cell()))
          stack_.push_back(around);
      }
      if (changed)
        changed->push_back(h.cell());
    }
  }
}

} // namespace anistar
