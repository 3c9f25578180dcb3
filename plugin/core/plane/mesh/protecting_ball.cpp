#include "plane/mesh/protecting_ball.h"

#include <algorithm>
#include <cmath>

namespace anistar {
namespace {

/// They leave nothing of an interval but round-off.
constexpr int n_bisections = 60;

} // namespace

ProtectingBall::ProtectingBall(Workspace &w) : w_(w) {
  const auto &edges = w.on_curves.curve_edges;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges[e].ball == none)
      continue;
    const std::size_t ball = edges[e].ball;
    entries_.resize(std::max(entries_.size(), ball + 1));
    entries_[ball].push_back(static_cast<Index>(e));
  }
}

bool ProtectingBall::gather(Index v) {
  PlaneTrial trial(w_);
  trial.gather(v);
  const SlidingVertex on(w_, trial.star(), v);
  if (!on.is_on_curve() || (on.in().ball == none && on.out().ball == none))
    return false;
  const Index ball = on.in().ball != none ? on.in().ball : on.out().ball;
  shell_.clear();
  legs_.clear();
  for (Index e : entries_[ball]) {
    const CurveEdge &edge = w_.on_curves.curve_edges[e];
    const auto stays = [&](Index u) {
      return w_.mesh.feature[u] == Triangulation<2>::corner;
    };
    if (stays(edge.v0) && stays(edge.v1))
      return false;
    shell_.push_back(stays(edge.v0) ? edge.v1 : edge.v0);
    trial.gather(shell_.back());
    const SlidingVertex other(w_, trial.star(), shell_.back());
    if (!other.is_on_curve())
      return false;
    legs_.push_back({trial, other, trial.score()});
  }
  gather_edges();
  disagreeing_before_ = count_disagreeing();
  return true;
}

/// The stars of the legs have edges in common, which count once. Those of curves do not
/// count: between the legs of a sharp corner a shell would shrink for them.
void ProtectingBall::gather_edges() {
  edges_.clear();
  for (const Leg &leg : legs_)
    leg.trial.for_each_edge([&](HalfFacet edge) {
      const HalfFacet other = w_.mesh.opposite(edge);
      const HalfFacet first =
          other.exists() && other.cell() < edge.cell() ? other : edge;
      if (w_.mesh.constraint(first) == none &&
          std::find(edges_.begin(), edges_.end(), first) == edges_.end())
        edges_.push_back(first);
    });
}

int ProtectingBall::count_disagreeing() const {
  return static_cast<int>(
      std::count_if(edges_.begin(), edges_.end(),
                    [&](HalfFacet edge) { return disagrees(w_.mesh, edge); }));
}

/// The change of the parameter that brings a vertex to `factor` times its distance from
/// the corner.
std::optional<double> ProtectingBall::step_to(const Leg &leg, double factor) const {
  const bool leaves = leg.on.in().ball != none;
  const CurveEdge &edge = leaves ? leg.on.in() : leg.on.out();
  const Vertex<2> &corner = w_.mesh.vertex(leaves ? edge.v0 : edge.v1);
  const double t = leg.on.in().t1;
  const auto squared_at = [&](double dt) {
    return quadratic<2>(corner.M, leg.on.at(dt) - corner.x);
  };
  const double wanted = factor * factor * squared_at(0);
  double inside = leaves ? leg.on.in().t0 - t : leg.on.out().t1 - t;
  double outside = leaves ? leg.on.out().t1 - t : leg.on.in().t0 - t;
  if (squared_at(outside) <= wanted)
    return {};
  for (int step = 0; step < n_bisections; ++step) {
    const double dt = .5 * (inside + outside);
    (squared_at(dt) < wanted ? inside : outside) = dt;
  }
  return outside;
}

bool ProtectingBall::resize(double factor) {
  for (std::size_t k = 0; k < legs_.size(); ++k) {
    Leg &leg = legs_[k];
    const std::optional<double> dt = step_to(leg, factor);
    if (!dt || !leg.on.may_slide(*dt) || !leg.trial.may_move_to(leg.on.at(*dt))) {
      put_back(k);
      return false;
    }
    leg.dt = *dt;
    leg.trial.put(leg.trial.at(leg.on.at(*dt)));
  }
  return true;
}

bool ProtectingBall::drops(int least) const {
  for (const Leg &leg : legs_)
    if (!leg.trial.score().keeps(leg.before, part_kept_on_curve))
      return false;
  return count_disagreeing() <= disagreeing_before_ - least;
}

bool ProtectingBall::raises_quality() const {
  double before = 1, after = 1;
  for (const Leg &leg : legs_) {
    before = std::min(before, leg.before.quality);
    after = std::min(after, leg.trial.score().quality);
  }
  return after > before;
}

void ProtectingBall::undo() { put_back(legs_.size()); }

void ProtectingBall::put_back(std::size_t n_legs) {
  for (std::size_t k = 0; k < n_legs; ++k)
    legs_[k].trial.put_back();
}

void ProtectingBall::commit() const {
  for (const Leg &leg : legs_)
    leg.on.commit(leg.dt);
}

} // namespace anistar
