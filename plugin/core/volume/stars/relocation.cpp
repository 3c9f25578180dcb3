#include "volume/stars/relocation.h"

#include "volume/mesh/vertex_star.h"

namespace anistar {
namespace {

constexpr int n_candidates = 6;
/// Trial places lie within these fractions of the radius, one after another: most
/// disagreements need a small move, some a large one.
constexpr double radius_fractions[] = {1, .4, .15};
/// Edges outside of this range are penalised, short ones more: they cost vertices.
constexpr double shortest_free = .58, longest_free = 1.65;
constexpr double short_weight = 10, long_weight = 4;
/// A trial must be better than the best by this much.
constexpr double least_gain = 1e-9;

/// Random moves: how many are tried, and what edges may cost then.
constexpr int n_wandering = 4;
constexpr double most_wandering_penalty = .2;

/// Polishing steps, as fractions of the step to the ideal place, and what they must
/// gain in the mean quality of the star. Shorter steps are not worth a trial.
constexpr double polish_fractions[] = {1, .5, .25};
constexpr double polish_gain = 1e-3, smallest_polish = .02;

} // namespace

/// @returns false when v may not move or its star is too large.
bool VolumeRelocation::gather(Index v) {
  const Triangulation<3> &mesh = volume_.mesh;
  if (volume_.feature(v) == Triangulation<3>::corner)
    return false;
  v_ = v;
  star_of(volume_, v, star_);
  if (star_.size() > StarShapes::capacity)
    return false;
  trial_ = mesh.vertex(v);
  shapes_.clear();
  facets_.clear();
  ring_.clear();
  volume_.open_vertices();
  volume_.mark_vertex(v);
  for (Index c : star_) {
    const std::size_t at = mesh.local_index(c, v);
    const Facet<3> t = facet_of<3>(mesh.at(c), at);
    shapes_.add(mesh.vertex(t[0]), mesh.vertex(t[1]), mesh.vertex(t[2]));
    for (Index u : t)
      if (volume_.mark_vertex(u))
        ring_.push_back(u);
    gather_facets(c, at);
  }
  return true;
}

/// The facets of a cell of the star that have another side and are no walls; those at v
/// from one of their cells only. @param at where v is in the cell
void VolumeRelocation::gather_facets(Index c, std::size_t at) {
  const Triangulation<3> &mesh = volume_.mesh;
  for (std::size_t i = 0; i < 4; ++i) {
    const HalfFacet h(c, i), other = mesh.opposite(h);
    if (!other.exists() || (i != at && other.cell() < c) || mesh.constraint(h) != none)
      continue;
    FacetStar star = facet_star(mesh, h);
    for (const Vertex<3> *&vertex : star)
      if (vertex == &mesh.vertex(v_))
        vertex = &trial_;
    facets_.push_back({h, star});
  }
}

VolumeRelocation::Score VolumeRelocation::here() {
  Score score;
  for (Index c : star_) {
    const double q = volume_.quality_of(c);
    score.cost.add_cell(q);
    score.quality_min = std::min(score.quality_min, q);
    score.quality_sum += q;
  }
  for (const TestedFacet &facet : facets_)
    score.cost.add_facet(static_cast<double>(state_.margins.at(facet.at)));
  score.lengths = length_penalty();
  return score;
}

double VolumeRelocation::length_penalty() const {
  double penalty = 0;
  for (Index u : ring_) {
    const double l = fast_length(volume_.mesh.vertex(u), trial_);
    penalty += short_weight * std::max(0., shortest_free - l) +
               long_weight * std::max(0., l - longest_free);
  }
  return penalty;
}

/// Puts the trial vertex at x, or where x goes on the surface or ridge of v.
/// @param background_cell hint in, found out
bool VolumeRelocation::place(const Vector<3> &x, Index &background_cell) {
  const Index feature = volume_.feature(v_);
  const Vector<3> on = volume_.surface.place(feature, volume_.support_of(v_), x);
  if (!is_in_range<3>(on))
    return false;
  if (feature != Triangulation<3>::interior &&
      !keeps_surfaces(volume_, star_, v_, on, state_.hausdorff_number))
    return false;
  trial_ = volume_.background.vertex(on, background_cell);
  ++trials_;
  return true;
}

/// @returns false as soon as the total is not below the limit or a cell is below the
/// floor.
bool VolumeRelocation::evaluate(double floor, double limit, Score &score) {
  shapes_.evaluate(trial_);
  score = {};
  score.quality_min = shapes_.minimum();
  score.quality_sum = shapes_.sum();
  if (score.quality_min < floor || score.quality_min <= 0)
    return false;
  qualities_.clear();
  for (std::size_t k = 0; k < star_.size(); ++k) {
    qualities_.push_back(shapes_.quality(k));
    score.cost.add_cell(static_cast<double>(shapes_.quality(k)));
  }
  score.lengths = length_penalty();
  margins_.clear();
  for (const TestedFacet &facet : facets_) {
    const float margin = as_margin(facet_margin(facet.star));
    margins_.push_back(margin);
    score.cost.add_facet(static_cast<double>(margin));
    if (score.total() >= limit)
      return false;
  }
  return true;
}

void VolumeRelocation::keep_trial() {
  best_margins_.swap(margins_);
  best_qualities_.swap(qualities_);
}

/// Keeps the trial, and what is there now as the trial to return to.
void VolumeRelocation::remember() {
  keep_trial();
  qualities_.clear();
  for (Index c : star_)
    qualities_.push_back(volume_.quality[c]);
  margins_.clear();
  for (const TestedFacet &facet : facets_)
    margins_.push_back(state_.margins.at(facet.at));
}

/// A random place near `from`, where nothing that the score knows is worse but shapes
/// above the floor.
bool VolumeRelocation::try_near(const Vertex<3> &from, double radius,
                                const Score &before, CounterRandom &random,
                                Index &background_cell) {
  const Matrix<3> L = lower_factor<3>(from.M);
  const double floor = std::min(before.quality_min, agreement_floor) - least_gain;
  Score score;
  return place(from.x + in_space(L, radius * random_in_ball(random)),
               background_cell) &&
         evaluate(floor, std::numeric_limits<double>::infinity(), score) &&
         score.cost.failing <= before.cost.failing &&
         score.lengths <= before.lengths + least_gain;
}

/// Moves v to the trial that was kept.
void VolumeRelocation::commit(const Vertex<3> &vertex, Index background_cell) {
  const std::size_t i = v_;
  volume_.mesh.vertices[i] = vertex;
  volume_.mesh.background_cell[i] = background_cell;
  for (std::size_t k = 0; k < star_.size(); ++k) {
    volume_.quality[star_[k]] = best_qualities_[k];
    volume_.touch(star_[k]);
    state_.changed.push_back(star_[k]);
  }
  for (std::size_t k = 0; k < facets_.size(); ++k)
    state_.margins.put(facets_[k].at, best_margins_[k]);
}

bool VolumeRelocation::relocate(Index v, double radius, CounterRandom &random) {
  if (!gather(v))
    return false;
  const Score before = here();
  if (before.cost.failing == 0 && before.cost.shortfall <= 0)
    return false;
  const Matrix<3> L = lower_factor<3>(trial_.M);
  const double floor = std::min(before.quality_min, agreement_floor) - least_gain;
  const Vector<3> start = trial_.x;
  double best_total = before.total() - least_gain;
  Vertex<3> best = trial_;
  Index best_cell = none;
  for (int k = 0; k < n_candidates; ++k) {
    const Vector<3> &centre = k < 3 ? start : best.x;
    const Vector<3> step =
        in_space(L, radius * radius_fractions[k % 3] * random_in_ball(random));
    Index at = volume_.mesh.background_cell[v];
    Score score;
    if (!place(centre + step, at) || !evaluate(floor, best_total, score))
      continue;
    keep_trial();
    best_total = score.total() - least_gain;
    best = trial_;
    best_cell = at;
  }
  if (best_cell == none)
    return false;
  commit(best, best_cell);
  return true;
}

bool VolumeRelocation::wander(Index v, double radius, CounterRandom &random) {
  if (!gather(v))
    return false;
  const Score before = here();
  const Matrix<3> L = lower_factor<3>(trial_.M);
  const double floor = std::min(before.quality_min, agreement_floor) - least_gain;
  const Vector<3> start = trial_.x;
  for (int k = 0; k < n_wandering; ++k) {
    Index at = volume_.mesh.background_cell[v];
    Score score;
    if (!place(start + in_space(L, radius * random_in_ball(random)), at) ||
        !evaluate(floor, std::numeric_limits<double>::infinity(), score) ||
        score.cost.failing > before.cost.failing + 1 ||
        score.lengths > std::max(before.lengths, most_wandering_penalty))
      continue;
    keep_trial();
    commit(trial_, at);
    return true;
  }
  return false;
}

bool VolumeRelocation::polish(Index v) {
  if (!gather(v))
    return false;
  const Matrix<3> L = lower_factor<3>(trial_.M);
  const auto seen = [&](const Vector<3> &x) -> Vector<3> { return L.transpose() * x; };
  const Vector<3> start = trial_.x, step = ideal_step(volume_, v, star_, seen);
  if (step.squaredNorm() < smallest_polish * smallest_polish)
    return false;
  const Score before = here();
  const double floor = std::min(before.quality_min, agreement_floor) - least_gain;
  const double gain = polish_gain * static_cast<double>(star_.size());
  // what fails is a whole number: this refuses one more, and lets facets come nearer
  const double limit = before.cost.failing + 1;
  for (const double fraction : polish_fractions) {
    Index at = volume_.mesh.background_cell[v];
    if (!place(start + in_space(L, fraction * step), at))
      continue;
    Score score;
    if (!evaluate(floor, std::numeric_limits<double>::infinity(), score) ||
        score.cost.failing >= limit || score.quality_sum < before.quality_sum + gain ||
        score.lengths > before.lengths + least_gain)
      continue;
    keep_trial();
    commit(trial_, at);
    return true;
  }
  return false;
}

} // namespace anistar
