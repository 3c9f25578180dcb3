#include "generate/refinement/rules/rules.h"

#include <algorithm>

namespace anistar::generate {
namespace {

/// Where the centre itself has no cavity that its star fills, points near to it are
/// tried.
constexpr PickRule centre_first{
    .delta = .05, .n_picks = 6, .must_avoid_slivers = false};
/// In place of r_tau where no rule refines the larger slivers either.
constexpr double any_radius = std::numeric_limits<double>::infinity();
constexpr int most_tries_of_edge = 5;
/// As a fraction of the points, inverted.
constexpr std::size_t growth_before_retry = 50;

double diagonal_of(const std::vector<Vector<3>> &points) {
  Vector<3> low = points.front(), high = low;
  for (const Vector<3> &x : points) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return (high - low).norm();
}

SizeField size_field(const Tetrahedralisation &input, const Sizes &sizes) {
  if (sizes.empty())
    return {};
  return sizes.size() == 1 ? SizeField(sizes.front()) : SizeField(input, sizes);
}

} // namespace

Rules::Rules(const Tetrahedralisation &input, const Sizes &sizes,
             const RefinementSettings &settings)
    : settings_(settings), mesh_(input), faces_(mesh_), clusters_(mesh_),
      size_(size_field(input, sizes)), pick_rule_(centre_first),
      floor_(settings.shortest_edge * diagonal_of(input.points)),
      insertions_(&record_.refinement) {
  record_.clusters = clusters_.n_clusters();
  record_.acute_pairs = faces_.n_acute_pairs();
}

void Rules::queue_all() {
  for (const auto &[edge, segment] : mesh_.sorted_subsegments())
    queues_.edges.push({edge});
  for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
    if (mesh_.is_alive(static_cast<Index>(c))) {
      consider_walls(static_cast<Index>(c));
      consider_cell(static_cast<Index>(c));
    }
}

/// Rule 1: an encroached constrained edge.
bool Rules::apply_rule_1() {
  std::optional<WaitingEdge> waiting = queues_.edges.pop();
  if (!waiting && try_put_off_edges())
    waiting = queues_.edges.pop();
  if (!waiting)
    return false;
  const Segment &e = waiting->edge;
  if (!exists(e) || !(is_encroached(e) || is_long(e)))
    return true;
  if (refine_edge(e, {.r_g = 0}) == Outcome::refused &&
      waiting->tries < most_tries_of_edge)
    put_off_.push_back({e, waiting->tries + 1});
  return true;
}

/// Where the point of one edge encroaches upon another, as with long ones side by side,
/// neither may have a cavity that its star fills before the other, or one further on,
/// is split. So those that failed are tried again when others have been.
bool Rules::try_put_off_edges() {
  if (put_off_.empty() || insertions_->edges == edges_at_last_try_)
    return false;
  edges_at_last_try_ = insertions_->edges;
  blocked_at_.clear();
  for (const WaitingEdge &waiting : put_off_)
    queues_.edges.push(waiting);
  put_off_.clear();
  return true;
}

/// Rule 2: an encroached constrained facet. Terminator: p, the encroaching vertex, is a
/// vertex of the complex, or on a face disjoint from F, or r_v > r_p.
bool Rules::apply_rule_2() {
  const std::optional<WaitingFacet> waiting = queues_.facets.pop();
  if (!waiting)
    return false;
  const HalfFacet f = mesh_.half_facet(waiting->cell, waiting->vertices);
  if (!f.exists() || mesh_.wall(f) == none)
    return true;
  const bool by_size = is_large(f);
  const Index p = encroaching_apex(f);
  if (p == none && !by_size)
    return true;
  Cause cause{.r_g = 0, .needs_no_longer = by_size};
  if (p != none) {
    const Carrier &carrier = mesh_.carriers[p];
    cause.r_g = mesh_.insertion_radius[p];
    cause.frees_facet = !carrier.is_on_facet() ||
                        carrier.kind == Carrier::Kind::vertex ||
                        faces_.are_disjoint(carrier, mesh_.wall(f));
  }
  if (conditionally_refine_facet(f, cause) == Outcome::elsewhere &&
      mesh_.half_facet(waiting->cell, waiting->vertices).exists())
    queues_.facets.push(*waiting);
  return true;
}

/// Rule 3: a bad tetrahedron, that of the largest ratio first.
bool Rules::apply_rule_3() {
  const std::optional<Index> t = queues_.cells.pop(mesh_);
  if (!t)
    return false;
  if (conditionally_refine_tet(*t) == Outcome::elsewhere && mesh_.is_alive(*t))
    consider_cell(*t);
  return true;
}

/// refine-edge(e). Terminator: if it is a rejected point that encroaches, only if
/// min r_w > r_g over what is inserted then.
Outcome Rules::refine_edge(const Segment &edge, const Cause &cause) {
  const Segment e{std::min(edge[0], edge[1]), std::max(edge[0], edge[1])};
  const Index segment = mesh_.segment_of(e[0], e[1]);
  const double r_e = .5 * (mesh_.points[e[1]] - mesh_.points[e[0]]).norm();
  if (cause.r_rejected > 0) {
    const double least = clusters_.least_insertion_radius(mesh_, segment, e[0], e[1]);
    if (!cause.needs_no_longer && least <= cause.r_g)
      return refuse(Refusal::edge_not_longer);
    if (!record_.edge_lemma.note(r_e / cause.r_rejected))
      return refuse(Refusal::against_lemma);
  }
  if (r_e < floor_)
    return refuse(Refusal::too_short);
  if (is_blocked(e))
    return refuse(Refusal::no_cavity);
  const double middle = clusters_.split_fraction(mesh_, segment, e[0], e[1]);
  const bool is_at_cluster = middle != .5;
  Picks picks(pick_rule_, settings_.seed, n_regions_++);
  BestPick best;
  while (picks.has_next()) {
    const double offset = .5 * picks.next(1)[0];
    const Site site = edge_site(e, is_at_cluster ? middle : middle + offset);
    if (cavity_.gather(mesh_, site) == CavityFlaw::no_flaw &&
        takes(site, cause.is_in_wedge ? any_radius : r_e, best))
      return insert(site);
    if (is_at_cluster)
      break;
  }
  if (!best.site)
    blocked_at_[e] = mesh_.points.size();
  return insert_best(best, cause, Refusal::no_cavity);
}

/// An edge that had no cavity has none before enough has changed.
bool Rules::is_blocked(const Segment &e) const {
  const auto found = blocked_at_.find(e);
  return found != blocked_at_.end() &&
         mesh_.points.size() < found->second + found->second / growth_before_retry;
}

/// conditionally-refine-facet(f): c = circumcenter(f); if c encroaches a constrained
/// edge e, refine-edge(e); else insert(c), under Terminator's rule 2.
Outcome Rules::conditionally_refine_facet(HalfFacet f, const Cause &cause) {
  const Ball ball = diametral_ball_of(f);
  const double r_f = ball.radius;
  if (cause.r_rejected > 0 && !record_.facet_lemma.note(r_f / cause.r_rejected))
    return refuse(Refusal::against_lemma);
  if (r_f < floor_)
    return refuse(Refusal::too_short);
  const Facet<3> v = mesh_.facet(f);
  const Vector<3> along = (mesh_.points[v[1]] - mesh_.points[v[0]]).normalized();
  const Vector<3> across =
      (mesh_.points[v[2]] - mesh_.points[v[0]]).cross(along).cross(along).normalized();
  Picks picks(cause.is_in_wedge ? wedge_pick_rule_ : pick_rule_, settings_.seed,
              n_regions_++);
  BestPick best;
  while (picks.has_next()) {
    const Vector<3> offset = picks.next(2);
    const Vector<3> c = ball.centre + r_f * (offset[0] * along + offset[1] * across);
    Cause rejected = cause;
    rejected.r_rejected = r_f * (1 - offset.norm());
    const FacetWalk walk = walk_in_facet(mesh_, faces_, f, c);
    if (walk.is_lost)
      continue;
    if (!walk.has_arrived()) {
      if (!encroaches(c, mesh_.points[walk.border[0]], mesh_.points[walk.border[1]]))
        return refuse(Refusal::hidden_by_edge);
      const Outcome outcome = refine_edge(walk.border, rejected);
      return outcome == Outcome::refused ? outcome : Outcome::elsewhere;
    }
    const Site site = facet_site(walk.wall, put_on_wall(mesh_, faces_, walk.wall, c));
    if (cavity_.gather(mesh_, site) != CavityFlaw::no_flaw ||
        !cavity_.contains(f.cell()))
      continue;
    find_encroached_edges(site.x);
    if (!edges_.empty())
      return refine_encroached_edges(rejected);
    const double r_v = cavity_.nearest_vertex(mesh_, site.x);
    if (!cause.needs_no_longer && !cause.frees_facet && r_v <= cause.r_g)
      return refuse(Refusal::facet_not_longer);
    if (takes(site, cause.is_in_wedge ? any_radius : r_f, best))
      return insert(site);
  }
  return insert_best(best, cause, Refusal::no_cavity);
}

/// conditionally-refine-tet(t): c = circumcenter(t); if c encroaches a constrained edge
/// e, refine-edge(e); else if it encroaches a constrained facet f,
/// conditionally-refine-facet(f); else insert(c).
Outcome Rules::conditionally_refine_tet(Index t) {
  const CellShape shape = shape_of(t);
  const bool by_size = is_large(shape);
  bool by_ratio = shape.ratio() > settings_.bound, is_in_wedge = false;
  if (!by_size)
    if (const std::optional<Refusal> refusal = acute_refusal(t, shape)) {
      if (by_ratio && !(eliminates_slivers_ && is_flatter_than_its_wedge(t)))
        return refuse(*refusal);
      by_ratio = false; // its ratio stays, but its angles may become better
      is_in_wedge = true;
    }
  const double r_t = shape.ball.radius;
  Cause cause{.r_g = mesh_.insertion_radius[shape.shortest_edge[1]],
              .needs_no_longer = by_size || !by_ratio,
              .must_improve = !by_size && !by_ratio,
              .is_in_wedge = is_in_wedge};
  Picks picks(pick_rule_, settings_.seed, n_regions_++);
  BestPick best;
  while (picks.has_next()) {
    const Vector<3> offset = picks.next(3);
    const Vector<3> c = shape.ball.centre + r_t * offset;
    cause.r_rejected = r_t * (1 - offset.norm());
    const SpaceWalk walk = walk_in_space(mesh_, t, c);
    if (walk.wall.exists())
      return refine_encroached_facets({&walk.wall, 1}, c, cause);
    if (walk.cell == none)
      continue;
    const Site site{c, {}, {walk.cell}, {}, {none, none}, false};
    if (cavity_.gather(mesh_, site) != CavityFlaw::no_flaw || !cavity_.contains(t))
      continue;
    find_encroached_edges(c);
    if (!edges_.empty())
      return refine_encroached_edges(cause);
    if (const auto facets = encroached_facets(c); !facets.empty())
      return refine_encroached_facets(facets, c, cause);
    if (takes(site, is_in_wedge ? any_radius : r_t, best))
      return insert(site);
  }
  return insert_best(best, cause, Refusal::no_cavity);
}

/// What was measured to be necessary beside Terminator's rules: the shape of such
/// tetrahedra is that of the input.
std::optional<Refusal> Rules::acute_refusal(Index t, const CellShape &shape) const {
  if (faces_.n_acute_pairs() == 0)
    return {};
  const auto join = [&](Index u, Index v) {
    return faces_.join_acute_facets(mesh_.carriers[u], mesh_.carriers[v]);
  };
  if (join(shape.shortest_edge[0], shape.shortest_edge[1]))
    return Refusal::acute_shortest_edge;
  const Cell<3> &cell = mesh_.cells[t];
  if (!std::all_of(cell.begin(), cell.end(),
                   [&](Index v) { return mesh_.carriers[v].is_on_facet(); }))
    return {};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      if (join(cell[i], cell[j]))
        return Refusal::acute_facets;
  return {};
}

} // namespace anistar::generate
