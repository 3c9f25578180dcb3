#include "plane/stars/insertion.h"

#include "plane/mesh/disagreement.h"

namespace anistar {
namespace {

/// New vertices keep this distance from the others in their own metric (packing).
constexpr double separation = .4;

} // namespace

HalfFacet Insertion::encroached(const Vertex<2> &p, Index cell) const {
  for (std::size_t i = 0; i < 3; ++i) {
    const HalfFacet edge(cell, i);
    const auto [a, b] = mesh_.facet(edge);
    if (mesh_.constraint(edge) != none &&
        encroaches_on_surface(mesh_.vertex(a), mesh_.vertex(b), p))
      return edge;
  }
  return {};
}

bool Insertion::gather(const Vertex<2> &p, Index cell) {
  Cavity &cavity = w_.cavity;
  cavity.clear();
  cavity.add(cell);
  for (std::size_t k = 0; k < cavity.cells().size(); ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfFacet edge(cavity.cells()[k], i), beyond = mesh_.opposite(edge);
      if (beyond.exists() && mesh_.constraint(edge) == none &&
          !cavity.contains(beyond.cell()) &&
          in_metric_sphere<2>(p.M, mesh_.simplex(beyond.cell()), p.x) == Side::inside)
        cavity.add(beyond.cell());
    }
  cavity.bound(none);
  const auto is_near = [&](Index v) {
    return quadratic<2>(p.M, mesh_.vertex(v).x - p.x) < separation * separation;
  };
  for (Index c : cavity.cells())
    if (std::any_of(mesh_.at(c).begin(), mesh_.at(c).end(), is_near))
      return false;
  return cavity.keeps_vertices() && cavity.is_star_shaped(p.x);
}

Hits Insertion::score(const Vertex<2> &p, double radius) {
  Hits hits;
  spokes_.clear();
  for (HalfFacet h : w_.cavity.facets())
    spokes_.push_back({mesh_.facet(h)[0], h});
  std::sort(spokes_.begin(), spokes_.end(),
            [](const Spoke &x, const Spoke &y) { return x.first < y.first; });
  for (HalfFacet h : w_.cavity.facets()) {
    const auto [ia, ib] = mesh_.facet(h);
    const Vertex<2> &a = mesh_.vertex(ia), &b = mesh_.vertex(ib);
    if (circumcircle(p.M, p.x, a.x, b.x).radius > radius)
      continue;
    const HalfFacet beyond = mesh_.opposite(h);
    if (beyond.exists() && mesh_.constraint(h) == none)
      hits.n += metrics_disagree(a, b, p, mesh_.vertex(mesh_.apex(beyond)));
    const auto next =
        std::lower_bound(spokes_.begin(), spokes_.end(), ib,
                         [](const Spoke &spoke, Index v) { return spoke.first < v; });
    if (next != spokes_.end() && next->first == ib) // cells (p, a, b) and (p, b, c)
      hits.n += metrics_disagree(p, b, mesh_.vertex(mesh_.facet(next->facet)[1]), a);
  }
  return hits;
}

Index Insertion::enter(const Vertex<2> &p, Index background_cell) {
  const Index v = mesh_.add_vertex(p, Triangulation<2>::interior, background_cell);
  w_.cavity.fill(v);
  return v;
}

} // namespace anistar
