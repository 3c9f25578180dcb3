// Where new points are put, which picks are taken, and what an insertion brings about.

#include "generate/refinement/rules/rules.h"

#include <algorithm>

namespace anistar::generate {

Site Rules::edge_site(const Segment &e, double fraction) {
  const Vector<3> &a = mesh_.points[e[0]], &b = mesh_.points[e[1]];
  Site site{(1 - fraction) * a + fraction * b,
            {Carrier::Kind::segment, mesh_.segment_of(e[0], e[1])},
            {},
            {},
            e,
            true};
  mesh_.cells_around(e[0], e[1], site.seeds);
  for (Index c : site.seeds)
    for (std::size_t i = 0; i < 4; ++i) {
      const Index v = mesh_.cells[c][i];
      if (v != e[0] && v != e[1] && mesh_.walls[c][i] != none)
        site.open_facets.push_back(mesh_.walls[c][i]);
    }
  std::sort(site.open_facets.begin(), site.open_facets.end());
  site.open_facets.erase(std::unique(site.open_facets.begin(), site.open_facets.end()),
                         site.open_facets.end());
  return site;
}

Site Rules::facet_site(HalfFacet f, const Vector<3> &x) const {
  const Index facet = mesh_.wall(f);
  Site site{x, {Carrier::Kind::facet, facet}, {f.cell()}, {facet}, {none, none}, false};
  if (const HalfFacet other = mesh_.opposite(f); other.exists())
    site.seeds.push_back(other.cell());
  return site;
}

/// Whether a point may be inserted at once. If not for a small sliver alone, it is
/// remembered where it is the best one so far.
/// @pre the cavity of the site has been gathered
bool Rules::takes(const Site &site, double r_tau, BestPick &best) {
  if (cavity_.nearest_vertex(mesh_, site.x) < floor_) {
    ++record_.of(Refusal::too_short);
    return false;
  }
  if (!pick_rule_.must_avoid_slivers)
    return true;
  const double cosine = small_sliver_cosine(site, r_tau);
  if (cosine <= pick_rule_.sliver_cosine)
    return true;
  if (cosine < best.cosine)
    best = {site, cosine};
  return false;
}

/// Where no pick avoids slivers, the least bad one: a rule that asks for a point gets
/// it, a sliver only if the angles become better.
Outcome Rules::insert_best(const BestPick &best, const Cause &cause,
                           Refusal otherwise) {
  if (!best.site)
    return refuse(otherwise);
  if (cavity_.gather(mesh_, *best.site) != CavityFlaw::no_flaw)
    return refuse(otherwise);
  if (cause.must_improve && best.cosine >= cavity_cosine())
    return refuse(Refusal::no_pick);
  return insert(*best.site);
}

/// insert(c), and what becomes encroached, large or bad by it is queued.
/// @pre the cavity of the site has been gathered
Outcome Rules::insert(const Site &site) {
  find_encroached_edges(site.x);
  record_.enlarged_cavities += cavity_.is_enlarged();
  record_.reduced_cavities += cavity_.is_reduced();
  const Index near = mesh_.cells[cavity_.cells().front()][0];
  const Index v = cavity_.fill(mesh_, site);
  size_.add_vertex(site.x, near);
  for (const Segment &e : edges_)
    if (e != site.split_edge)
      queues_.edges.push({e});
  switch (site.carrier.kind) {
  case Carrier::Kind::segment:
    ++insertions_->edges;
    for (Index end : site.split_edge)
      queues_.edges.push({{std::min(end, v), std::max(end, v)}});
    break;
  case Carrier::Kind::facet:
    ++insertions_->facets;
    break;
  default:
    ++insertions_->tetrahedra;
  }
  const bool is_reduced = cavity_.is_reduced();
  if (is_reduced)
    flips_.restore(mesh_, cavity_.new_cells());
  for (Index c : cavity_.new_cells())
    if (mesh_.is_alive(c) && !(is_reduced && flips_.has_made(c))) {
      consider_walls(c);
      consider_cell(c);
    }
  if (is_reduced)
    consider_flipped();
  return Outcome::inserted;
}

/// What flips have made of hidden cells may be encroached upon, large or bad.
void Rules::consider_flipped() {
  constexpr std::array<std::array<std::size_t, 2>, 6> pairs{
      {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
  for (Index c : flips_.new_cells()) {
    if (!mesh_.is_alive(c))
      continue;
    const Cell<3> &cell = mesh_.cells[c];
    for (const auto &[i, j] : pairs)
      if (mesh_.segment_of(cell[i], cell[j]) != none)
        queues_.edges.push({{std::min(cell[i], cell[j]), std::max(cell[i], cell[j])}});
    consider_walls(c);
    consider_cell(c);
  }
}

} // namespace anistar::generate
