#include "volume/passes/passes.h"

#include "base/random.h"
#include "volume/passes/slab_team.h"

namespace anistar {
namespace {

/// Below this a star is stuck: a collapse may keep an edge of it that is too long.
constexpr double stuck_quality = .1;
/// Steps shorter than this, in the metric, are not worth a trial in a good star.
constexpr double smallest_step = .02;
/// Moves may not take the worst cell below this, or below where it is.
constexpr double move_floor = .35;
/// Facets of less, twice the area in the metric, tell no place of their apex.
constexpr double smallest_facet = 1e-12;
/// Parts of the step to the ideal place that are tried.
constexpr double step_fractions[] = {1, .4};
/// Random trials for stars below this quality, within this radius.
constexpr double random_below = .4, random_radius = .2;
/// The ideal place is not looked for nearer than that in a star above this quality.
constexpr double good_quality = .5;
/// Moves that raise the worst cell may lower the mean quality of the star by so much;
/// others must raise it by this.
constexpr double mean_loss = .02, mean_gain = .002;
/// What a move must add to the worst cell, and what is round-off of it.
constexpr double least_gain = 1e-4, round_off = 1e-6;
/// An edge whose square in the metric of one end exceeds this times the bound is not
/// below the bound in the mean, whatever the other end says within reason.
constexpr double clearly_longer = 4;
/// Edges that a re-insertion may make.
constexpr double longest_reinserted = 1.6;

} // namespace

double VolumePasses::star_quality() const {
  double worst = 1;
  for (Index c : star_)
    worst = std::min(worst, volume_.quality_of(c));
  return worst;
}

/// Marks the vertices that v, on a surface, may move to: those joined to it by an edge
/// of the surface.
void VolumePasses::note_surface_neighbours(Index v) {
  const Triangulation<3> &mesh = volume_.mesh;
  ring_.clear();
  for (Index c : star_) {
    if (!volume_.is_walled(c))
      continue;
    const std::size_t at = mesh.local_index(c, v);
    for (std::size_t i = 0; i < 4; ++i) {
      if (i == at || mesh.constraint(HalfFacet(c, i)) == none)
        continue;
      for (std::size_t j = 0; j < 4; ++j)
        if (j != i && j != at)
          ring_.push_back(mesh.at(c)[j]);
    }
  }
}

bool VolumePasses::may_collapse(Index v, Index u) const {
  switch (volume_.feature(v)) {
  case 3:
    return true;
  case 2:
    return std::find(ring_.begin(), ring_.end(), u) != ring_.end();
  case 1: {
    const Index edge = volume_.ridges.find(v, u);
    if (edge == none)
      return false;
    Index beyond = none;
    volume_.ridges.around(v, [&](Index, Index other) {
      if (other != u)
        beyond = other;
    });
    return beyond != none && volume_.ridges.find(u, beyond) == none;
  }
  default:
    return false;
  }
}

/// Whether the ridge stays near its curve when v goes to its neighbour u.
bool VolumePasses::follows_curve(Index v, Index u) const {
  Index beyond = none;
  volume_.ridges.around(v, [&](Index, Index other) {
    if (other != u)
      beyond = other;
  });
  return !is_off_curve(volume_.support_of(v), volume_.mesh.vertex(u),
                       volume_.mesh.vertex(beyond));
}

/// @pre star_ is the star of v.
bool VolumePasses::collapse(Index v, Index u, const Acceptance &acceptance) {
  if (volume_.feature(v) == 1 && !follows_curve(v, u))
    return false;
  if (!operator_.replace(star_, u, {v, none}, acceptance))
    return false;
  if (volume_.feature(v) == 1)
    volume_.ridges.contract(v, u);
  volume_.remove_vertex(v);
  return true;
}

bool VolumePasses::collapse_shortest(Index v, const VertexRule &rule) {
  const Triangulation<3> &mesh = volume_.mesh;
  if (volume_.feature(v) == 2)
    note_surface_neighbours(v);
  const Vertex<3> &here = mesh.vertex(v);
  Index best = none;
  double shortest = rule.shortest;
  volume_.open_vertices();
  volume_.mark_vertex(v);
  for (Index c : star_)
    for (Index u : mesh.at(c)) {
      if (!volume_.mark_vertex(u))
        continue;
      const Vertex<3> &there = mesh.vertex(u);
      const Vector<3> e = there.x - here.x;
      const double square = quadratic<3>(here.M, e);
      // a mean is not below both
      if (square > clearly_longer * shortest ||
          std::min(square, quadratic<3>(there.M, e)) >= shortest * shortest)
        continue;
      const double l = fast_length(here, there);
      if (l < shortest && may_collapse(v, u)) {
        shortest = l;
        best = u;
      }
    }
  if (best == none)
    return false;
  Acceptance acceptance{rule.collapse_floor, 1e-4, rule.longest, run_.hausdorff.surface};
  if (star_quality() < stuck_quality)
    for (Index c : star_)
      for (Index u : mesh.at(c))
        acceptance.longest =
            std::max(acceptance.longest, fast_length(here, mesh.vertex(u)));
  if (!collapse(v, best, acceptance)) {
    star_of(volume_, v, star_); // the trial has used the marks
    return false;
  }
  ++counts_.collapses;
  return true;
}

/// Moves v there when that makes its star better.
bool VolumePasses::try_move(const Vector<3> &x) {
  trial_.place(x);
  if (!trial_.is_positive())
    return false;
  trial_.take_metric();
  const StarShapes &shapes = trial_.measure();
  const double worst = trial_.least_before(), least = shapes.minimum();
  const double floor = std::min(worst, move_floor);
  if (least < floor - round_off || least <= 0)
    return false;
  const double n = static_cast<double>(shapes.size());
  const double sum = trial_.sum_before(), total = shapes.sum();
  const bool is_better =
      (least > better_by(least_gain, worst) && total > sum - mean_loss * n) ||
      total > sum + mean_gain * n;
  if (!is_better || !trial_.keeps_surfaces())
    return false;
  trial_.commit();
  ++counts_.moves;
  return true;
}

/// @pre star_ is the star of v.
void VolumePasses::move(Index v) {
  if (!trial_.gather(v, star_))
    return;
  const Vertex<3> here = volume_.mesh.vertex(v);
  const Matrix<3> L = lower_factor<3>(here.M);
  const double worst = trial_.least_before();
  const Vector<3> ideal = ideal_step(
      volume_, v, star_, [&](const Vector<3> &step) { return in_metric(L, step); },
      smallest_facet);
  if (ideal.squaredNorm() < smallest_step * smallest_step && worst > good_quality)
    return;
  for (const double fraction : step_fractions)
    if (try_move(here.x + in_space(L, fraction * ideal)))
      return;
  if (worst > random_below)
    return;
  CounterRandom random(run_.seed, Stream::relocate, v, volume_.clock);
  (void)try_move(here.x + in_space(L, random_radius * random_in_ball(random)));
}

/// @pre star_ is the star of v, marked.
void VolumePasses::reinsert(Index v, double floor) {
  const std::size_t n_star = star_.size();
  grow_cavity(volume_, v, star_);
  if (volume_.is_put_off)
    return;
  if (star_.size() == n_star)
    return;
  const Acceptance acceptance{.floor = std::min(floor, star_quality()),
                              .gain = 0,
                              .longest = longest_reinserted,
                              .is_apex_in_place = true};
  if (operator_.replace(star_, v, {none, none}, acceptance))
    ++counts_.insertions;
}

/// @param is_placed whether v waits only for its re-insertion
void VolumePasses::treat_vertex(Index v, const VertexRule &rule,
                                std::uint8_t &is_placed) {
  star_of(volume_, v, star_);
  if (is_placed == 0) {
    if (collapse_shortest(v, rule) || volume_.is_put_off)
      return;
    move(v);
    is_placed = 1;
  }
  if (rule.reinsert)
    reinsert(v, rule.reinsertion_floor);
}

void VolumePasses::vertices(const VertexRule &rule) {
  const std::uint32_t since = begin(Pass::vertex);
  const Triangulation<3> &mesh = volume_.mesh;
  std::vector<Index> all;
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k)
    if (mesh.is_used(static_cast<Index>(k)) &&
        mesh.feature[k] != Triangulation<3>::corner)
      all.push_back(static_cast<Index>(k));
  PerVertex<std::uint8_t> is_placed(mesh.vertices.size(), 0);
  in_slabs(
      std::move(all),
      [&](Index v, int round) { // the graph of ridges is no slab's
        return volume_.feature(v) <= 1 ? Slabs::nowhere
                                       : volume_.state.slabs.of_star(v, round);
      },
      [&, since](VolumePasses &passes, Index v) {
        if (mesh.is_used(v) && volume_.vertex_clock[v] >= since)
          passes.treat_vertex(v, rule, is_placed[v]);
      });
}

} // namespace anistar
