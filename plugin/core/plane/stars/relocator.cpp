#include "plane/stars/relocator.h"

#include "base/ellipse_sampler.h"
#include "plane/mesh/displacements.h"
#include "plane/mesh/sliding_vertex.h"

namespace anistar {
namespace {

constexpr int n_candidates = 20;
/// After so many the first place where all metrics agree is taken.
constexpr int enough_candidates = 7;
/// Candidates lie within this metric distance; the radius grows from pass to pass.
constexpr double first_radius = .12, last_radius = .3;
constexpr int flip_cap = 20;
constexpr int n_plateau_candidates = 6;
constexpr double plateau_radius = .2;
/// The first candidates of polishing are a pliant step, twice and four times as much.
constexpr int n_polish_candidates = 10, n_pliant_candidates = 3;
/// A polishing move must lower the excess by this much.
constexpr double least_gain = 1e-3;

} // namespace

/// Gathers the star of v. @returns false when not all of what a move looks at, cells of
/// the star and across its link, is in the range; curves are in no bounded range.
bool Relocator::enter(Index v, const VertexRange &range) {
  range_ = range;
  legaliser_.restrict_to(range);
  if (mesh_.feature[v] == 1 && !range.is_unbounded())
    return false;
  trial_.gather(v);
  return range.is_unbounded() ||
         std::all_of(trial_.star().begin(), trial_.star().end(), [&](HalfFacet h) {
           const HalfFacet beyond = mesh_.opposite(h);
           return range.contains(mesh_.at(h.cell())) &&
                  (!beyond.exists() || range.contains(mesh_.at(beyond.cell())));
         });
}

bool Relocator::relocate(Index v, int pass, const VertexRange &range) {
  if (!enter(v, range))
    return false;
  const double part = static_cast<double>(pass) / (max_agreement_passes - 1);
  (void)move(v, first_radius + (last_radius - first_radius) * part, pass);
  list_around(v);
  return true;
}

bool Relocator::wander(Index v, int round, const VertexRange &range) {
  if (!enter(v, range))
    return false;
  if (!move(v, last_radius, max_agreement_passes + round))
    move_randomly(v, round);
  list_around(v);
  return true;
}

bool Relocator::move(Index v, double radius, int pass) {
  const Index feature = mesh_.feature[v];
  if (feature == Triangulation<2>::corner || trial_.count_disagreeing() == 0)
    return false;
  CounterRandom random(seed_, Stream::relocate, v, pass);
  return feature == 1 ? move_on_curve(v, random, 1) : move_freely(v, radius, random);
}

bool Relocator::move_freely(Index v, double radius, CounterRandom &random) {
  const std::vector<HalfFacet> &star = trial_.star();
  const Place &from = trial_.from();
  const Vector<2> x0 = from.vertex.x;
  const StarScore before = trial_.score();
  const EllipseSampler ellipse(from.vertex.M);
  const Vector<2> pliant = x0 + pliant_displacement(mesh_, from.vertex, star);
  const Vector<2> odt = x0 + odt_displacement(mesh_, from.vertex, star);
  Place best = from;
  StarScore best_score = before;
  for (int k = 0; k < n_candidates; ++k) {
    Vector<2> x = k == 0 ? pliant : odt;
    if (k > 1)
      x = (k % 2 ? x0 : pliant) + ellipse.step(radius, random);
    if (!trial_.may_move_to(x))
      continue;
    const auto [place, found] = try_at(x);
    if (!found.keeps(before) || found.disagreeing >= before.disagreeing ||
        found.disagreeing > best_score.disagreeing ||
        (found.disagreeing == best_score.disagreeing &&
         found.excess >= best_score.excess))
      continue;
    best = place;
    best_score = found;
    if (found.disagreeing == 0 && k >= enough_candidates)
      break;
  }
  if (best_score.disagreeing >= before.disagreeing)
    return false;
  trial_.put(best);
  settle(v);
  return true;
}

std::pair<Place, StarScore> Relocator::try_at(const Vector<2> &x) {
  ++counts_.trials;
  const Place place = trial_.at(x);
  return {place, trial_.score_at(place)};
}

/// @param least_drop of the number of disagreeing edges
bool Relocator::move_on_curve(Index v, CounterRandom &random, int least_drop) {
  const SlidingVertex on(w_, trial_.star(), v);
  if (!on.can_slide())
    return resize_ball(v, random, least_drop);
  const StarScore before = trial_.score();
  for (int k = 0; k < n_candidates; ++k) {
    const double r = 2 * last_radius * (random.uniform() - .5);
    const double dt = r * (r > 0 ? on.room_after() : on.room_before());
    if (!on.may_slide(dt) || !trial_.may_move_to(on.at(dt)))
      continue;
    const auto [place, found] = try_at(on.at(dt));
    if (!found.keeps(before, part_kept_on_curve) ||
        found.disagreeing > before.disagreeing - least_drop)
      continue;
    trial_.put(place);
    on.commit(dt);
    settle(v);
    return true;
  }
  return false;
}

/// Moves all vertices of the shell that v is on.
bool Relocator::resize_ball(Index v, CounterRandom &random, int least_drop) {
  if (!ball_)
    ball_.emplace(w_);
  if (!ball_->gather(v))
    return false;
  for (int k = 0; k < n_candidates; ++k) {
    const double factor = 1 + 2 * last_radius * (random.uniform() - .5);
    if (!ball_->resize(factor))
      continue;
    ++counts_.trials;
    if (!ball_->drops(least_drop)) {
      ball_->undo();
      continue;
    }
    ball_->commit();
    for (Index u : ball_->shell())
      settle(u);
    for (Index u : ball_->shell()) // no flip tells of the edges of the other legs
      list_around(u);
    return true;
  }
  return false;
}

void Relocator::move_randomly(Index v, int round) {
  const Index feature = mesh_.feature[v];
  if (feature == Triangulation<2>::corner)
    return;
  CounterRandom random(seed_, Stream::wander, v, round);
  if (feature == 1) {
    (void)move_on_curve(v, random, 0);
    return;
  }
  const Place &from = trial_.from();
  const StarScore before = trial_.score();
  const EllipseSampler ellipse(from.vertex.M);
  for (int k = 0; k < n_plateau_candidates; ++k) {
    const Vector<2> x = from.vertex.x + ellipse.step(plateau_radius, random);
    if (!trial_.may_move_to(x))
      continue;
    const auto [place, found] = try_at(x);
    if (found.keeps(before) && found.disagreeing <= before.disagreeing) {
      trial_.put(place);
      settle(v);
      return;
    }
  }
}

bool Relocator::polish(Index v, int sweep, const VertexRange &range) {
  if (!enter(v, range))
    return false;
  if (!trial_.has_excess())
    return true;
  const Place &from = trial_.from();
  const Vector<2> x0 = from.vertex.x;
  const StarScore before = trial_.score();
  const EllipseSampler ellipse(from.vertex.M);
  CounterRandom random(seed_, Stream::polish, v, sweep);
  const Vector<2> pliant = pliant_displacement(mesh_, from.vertex, trial_.star());
  Place best = from;
  double best_excess = before.excess - least_gain;
  for (int k = 0; k < n_polish_candidates; ++k) {
    const Vector<2> step = k < n_pliant_candidates
                               ? Vector<2>((1 << k) * pliant)
                               : ellipse.step(plateau_radius, random);
    const Vector<2> x = x0 + step;
    if (!trial_.may_move_to(x))
      continue;
    const auto [place, found] = try_at(x);
    if (found.excess < best_excess && found.keeps(before) &&
        found.disagreeing <= before.disagreeing) {
      best = place;
      best_excess = found.excess;
    }
  }
  if (best_excess < before.excess - least_gain) {
    trial_.put(best);
    ++counts_.moves;
    list_around(v);
  }
  return true;
}

/// Flips around a moved vertex, and lists what disagrees where cells changed.
void Relocator::settle(Index v) {
  ++counts_.moves;
  changed_.clear();
  legaliser_.push_star(v);
  legaliser_.run(flip_cap, &changed_);
  for (Index c : changed_)
    for (std::size_t i = 0; i < 3; ++i)
      list_if_disagreeing(HalfFacet(c, i));
}

void Relocator::list_around(Index v) {
  trial_.gather(v);
  trial_.for_each_edge([&](HalfFacet edge) { list_if_disagreeing(edge); });
}

/// Where the vertex on the other side is in another block, which may be moving it, the
/// edge is listed without looking.
void Relocator::list_if_disagreeing(HalfFacet edge) {
  if (edges_ == Edges::inner && mesh_.constraint(edge) != none)
    return;
  const HalfFacet other = mesh_.opposite(edge);
  if ((other.exists() && !range_.contains(mesh_.at(other.cell()))) ||
      disagrees(mesh_, edge))
    for_quad(mesh_, edge, [&](Index v) { listed_.push_back(v); });
}

} // namespace anistar
