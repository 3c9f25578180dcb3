// What follows when a point is rejected, because it encroaches upon edges or facets.

#include "generate/refinement/rules/rules.h"

#include <algorithm>

namespace anistar::generate {

/// The subsegments of the cavity that a point encroaches upon.
void Rules::find_encroached_edges(const Vector<3> &p) {
  cavity_.subsegments(mesh_, edges_);
  std::erase_if(edges_, [&](const Segment &e) {
    return !encroaches(p, mesh_.points[e[0]], mesh_.points[e[1]]);
  });
}

std::vector<HalfFacet> Rules::encroached_facets(const Vector<3> &p) const {
  std::vector<HalfFacet> out;
  for (HalfFacet h : cavity_.boundary())
    if (mesh_.wall(h) != none && encroaches(p, diametral_ball_of(h)))
      out.push_back(h);
  return out;
}

Outcome Rules::refine_encroached_edges(const Cause &cause) {
  const std::vector<Segment> edges = edges_;
  for (const Segment &e : edges)
    if (refine_edge(e, cause) != Outcome::refused)
      return Outcome::elsewhere;
  return Outcome::refused;
}

Outcome Rules::refine_encroached_facets(std::span<const HalfFacet> facets,
                                        const Vector<3> &p, const Cause &cause) {
  bool is_hidden = true;
  for (HalfFacet f : facets) {
    const HalfFacet g = facet_below(f, p);
    if (!encroaches(p, diametral_ball_of(g)))
      continue;
    is_hidden = false;
    if (conditionally_refine_facet(g, cause) != Outcome::refused)
      return Outcome::elsewhere;
  }
  return is_hidden ? refuse(Refusal::hidden_by_facet) : Outcome::refused;
}

/// The projection lemma: of the walls of F that which holds the projection of the
/// encroaching point, which encroaches upon it as well.
HalfFacet Rules::facet_below(HalfFacet f, const Vector<3> &p) const {
  const Facet<3> v = mesh_.facet(f);
  const Vector<3> &a = mesh_.points[v[0]];
  const Vector<3> n = (mesh_.points[v[1]] - a).cross(mesh_.points[v[2]] - a);
  const Vector<3> projection = p - n * (n.dot(p - a) / n.squaredNorm());
  const FacetWalk walk = walk_in_facet(mesh_, faces_, f, projection);
  return walk.has_arrived() && encroaches(p, diametral_ball_of(walk.wall)) ? walk.wall
                                                                           : f;
}

} // namespace anistar::generate
