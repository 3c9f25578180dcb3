#include "volume/stars/relocation.h"

#include <limits>

namespace anistar {
namespace {

/// A trial must be better than the best by this much.
constexpr double least_gain = 1e-9;

/// Directed steps: how many one vertex makes at once, how far each goes, the parts of
/// it that are tried, and what is no step.
constexpr int max_steps = 2;
constexpr double longest_step = .35, shortest_step = 1e-4;
constexpr double step_fractions[] = {1, .5};

/// Random places lie within these fractions of the radius, one after another: most
/// disagreements need a small move, some a large one.
constexpr double radius_fractions[] = {1, .4, .15};

/// Moves that wander: how many are tried, and what edges may cost then.
constexpr int n_wandering = 4;
constexpr double most_wandering_penalty = .2;

/// Polishing steps, as fractions of the step to the ideal place, and what they must
/// gain in the mean quality of the star. Shorter steps are not worth a trial.
constexpr double polish_fractions[] = {1, .5, .25};
constexpr double polish_gain = 1e-3, smallest_polish = .02;
/// How far a polish beside the straight way goes.
constexpr double longest_polish = .5;

/// Below which the quality of no cell may fall.
[[nodiscard]] double floor_of(double quality_before) {
  return std::min(quality_before, agreement_floor) - least_gain;
}

} // namespace

bool VolumeRelocation::step(Index v) {
  if (view_.state.is_stuck[v] != 0)
    return false;
  int n = 0;
  while (n < max_steps && vertex_.gather(v) && step_once())
    ++n;
  if (n == 0 && !volume_.is_put_off)
    view_.state.is_stuck[v] = 1;
  return n > 0;
}

bool VolumeRelocation::step_once() {
  const PlaceScore before = vertex_.score_here();
  if (before.cost.failing == 0)
    return false;
  const double floor = floor_of(before.quality_min);
  bounds_.begin(volume_, vertex_);
  bounds_.keep_facets(vertex_);
  bounds_.keep_qualities(volume_, vertex_, floor);
  bounds_.keep_lengths(volume_, vertex_);
  Vector<3> y;
  do
    y = bounds_.nearest(Vector<3>::Zero(), longest_step);
  while (bounds_.give_up(y));
  if (y.squaredNorm() < shortest_step * shortest_step)
    return false;
  const Vector<3> start = vertex_.home().x;
  for (const double fraction : step_fractions)
    if (vertex_.place(start + bounds_.in_space(fraction * y)) &&
        vertex_.evaluate(floor, before.total() - least_gain)) {
      vertex_.move_here();
      return true;
    }
  return false;
}

bool VolumeRelocation::relocate(Index v, const RandomPlaces &places,
                                CounterRandom &random) {
  if (!vertex_.gather(v))
    return false;
  const PlaceScore before = vertex_.score_here();
  return (before.cost.failing > 0 || before.cost.shortfall > 0) &&
         try_all(places, before, random);
}

bool VolumeRelocation::make_room(Index v, const RandomPlaces &places,
                                 CounterRandom &random) {
  if (!vertex_.gather(v))
    return false;
  const PlaceScore before = vertex_.score_here();
  return before.cost.nearness > 0 && try_all(places, before, random);
}

bool VolumeRelocation::try_all(const RandomPlaces &places, const PlaceScore &before,
                               CounterRandom &random) {
  const Matrix<3> L = lower_factor<3>(vertex_.home().M);
  const double floor = floor_of(before.quality_min);
  const Vector<3> start = vertex_.home().x;
  Vector<3> best = start;
  double best_total = before.total() - least_gain;
  bool found = false;
  for (int k = 0; k < places.n; ++k) {
    const Vector<3> step =
        in_space(L, places.radius * radius_fractions[k % 3] * random_in_ball(random));
    if (!vertex_.place((k < 3 ? start : best) + step))
      continue;
    const std::optional<PlaceScore> score = vertex_.evaluate(floor, best_total);
    if (!score)
      continue;
    vertex_.remember();
    best = vertex_.tried().x;
    best_total = score->total() - least_gain;
    found = true;
  }
  if (found)
    vertex_.move_to_best();
  return found;
}

bool VolumeRelocation::wander(Index v, double radius, CounterRandom &random) {
  if (!vertex_.gather(v))
    return false;
  const PlaceScore before = vertex_.score_here();
  const Matrix<3> L = lower_factor<3>(vertex_.home().M);
  const double floor = floor_of(before.quality_min);
  const double most_lengths = std::max(before.lengths, most_wandering_penalty);
  for (int k = 0; k < n_wandering; ++k) {
    if (!vertex_.place(vertex_.home().x + in_space(L, radius * random_in_ball(random))))
      continue;
    const std::optional<PlaceScore> score =
        vertex_.evaluate(floor, std::numeric_limits<double>::infinity());
    if (!score || score->cost.failing > before.cost.failing + 1 ||
        score->lengths > most_lengths)
      continue;
    vertex_.move_here();
    return true;
  }
  return false;
}

bool VolumeRelocation::polish(Index v) {
  if (!vertex_.gather_star(v))
    return false;
  const Vector<3> start = vertex_.home().x;
  const Matrix<3> L = lower_factor<3>(vertex_.home().M);
  const auto seen = [&](const Vector<3> &x) -> Vector<3> { return L.transpose() * x; };
  const Vector<3> step = ideal_step(volume_, v, vertex_.star(), seen);
  if (step.squaredNorm() < smallest_polish * smallest_polish)
    return false;
  const double gain = polish_gain * static_cast<double>(vertex_.star().size());
  const ShapeDemand demand{floor_of(vertex_.least_quality()),
                           vertex_.sum_of_qualities() + gain};
  std::optional<PlaceScore> before; // few places are good enough to ask for it
  double wanted = 0;                // the part of the step that only facets forbid
  for (const double fraction : polish_fractions) {
    if (!vertex_.place(start + in_space(L, fraction * step), demand))
      continue;
    if (!before) {
      if (!vertex_.gather_around())
        return false;
      before = vertex_.score_here();
    }
    if (vertex_.disagrees_no_more(*before)) {
      vertex_.move_here();
      return true;
    }
    wanted = std::max(wanted, fraction);
  }
  return wanted > 0 && polish_beside(wanted * step, demand, *before);
}

/// The place as near to the wanted one as the facets let.
bool VolumeRelocation::polish_beside(const Vector<3> &wanted, const ShapeDemand &demand,
                                     const PlaceScore &before) {
  vertex_.return_home();
  bounds_.begin(volume_, vertex_);
  bounds_.keep_facets(vertex_);
  bounds_.keep_lengths(volume_, vertex_);
  const Vector<3> start = vertex_.home().x, y = bounds_.nearest(wanted, longest_polish);
  for (const double fraction : step_fractions)
    if (vertex_.place(start + bounds_.in_space(fraction * y), demand) &&
        vertex_.disagrees_no_more(before)) {
      vertex_.move_here();
      return true;
    }
  return false;
}

} // namespace anistar
