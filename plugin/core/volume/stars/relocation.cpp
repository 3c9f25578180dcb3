#include "volume/stars/relocation.h"

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

/// Places that are tried where the caller decides.
constexpr int n_places = 16;
/// Random moves: how many are tried, and what edges may cost then.
constexpr int n_wandering = 4;
constexpr double most_wandering_penalty = .2;

/// Polishing steps, as fractions of the step to the ideal place, and what they must
/// gain in the mean quality of the star. Shorter steps are not worth a trial.
constexpr double polish_fractions[] = {1, .5, .25};
constexpr double polish_gain = 1e-3, smallest_polish = .02;

constexpr double no_limit = std::numeric_limits<double>::infinity();

/// Below which the quality of no cell may fall.
[[nodiscard]] double floor_of(double quality_before) {
  return std::min(quality_before, agreement_floor) - least_gain;
}

} // namespace

/// @returns false when v may not move or its star is too large.
bool VolumeRelocation::gather_star(Index v) {
  if (volume_.feature(v) == Triangulation<3>::corner)
    return false;
  v_ = v;
  star_of(volume_, v, star_);
  return trial_.gather(v, star_);
}

/// Takes up the edges and facets around v. @pre its star was gathered
void VolumeRelocation::gather_around() {
  const Triangulation<3> &mesh = volume_.mesh;
  facets_.clear();
  ring_.clear();
  volume_.open_vertices();
  volume_.mark_vertex(v_);
  for (Index c : star_) {
    const std::size_t at = mesh.local_index(c, v_);
    for (Index u : facet_of<3>(mesh.at(c), at))
      if (volume_.mark_vertex(u))
        ring_.push_back(u);
    gather_facets(c, at);
  }
}

bool VolumeRelocation::gather(Index v) {
  if (!gather_star(v))
    return false;
  gather_around();
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
        vertex = &trial_.vertex();
    facets_.push_back({h, star});
  }
}

/// Of v where it is in the mesh.
VolumeRelocation::Score VolumeRelocation::score_here() {
  Score score;
  for (Index c : star_)
    score.cost.add_cell(volume_.quality_of(c));
  score.quality_min = trial_.least_before();
  score.quality_sum = trial_.sum_before();
  for (const TestedFacet &facet : facets_)
    score.cost.add_facet(static_cast<double>(state_.margins.at(facet.at)));
  score.lengths = length_penalty(volume_.mesh.vertex(v_));
  return score;
}

double VolumeRelocation::length_penalty(const Vertex<3> &at) const {
  double penalty = 0;
  for (Index u : ring_) {
    const double l = fast_length(volume_.mesh.vertex(u), at);
    penalty += short_weight * std::max(0., shortest_free - l) +
               long_weight * std::max(0., l - longest_free);
  }
  return penalty;
}

/// Tries x, or where x goes on the surface or ridge of the vertex.
bool VolumeRelocation::place(const Vector<3> &x) {
  trial_.place(x);
  if (!is_in_range<3>(trial_.vertex().x) || !trial_.keeps_surfaces())
    return false;
  trial_.take_metric();
  ++trials_;
  return true;
}

/// What the place is worth; nothing as soon as the total is not below the limit or a
/// cell is below the floor.
std::optional<VolumeRelocation::Score> VolumeRelocation::evaluate(double floor,
                                                                  double limit) {
  const StarShapes &shapes = trial_.measure();
  Score score;
  score.quality_min = shapes.minimum();
  score.quality_sum = shapes.sum();
  if (score.quality_min < floor || score.quality_min <= 0)
    return {};
  for (std::size_t k = 0; k < star_.size(); ++k)
    score.cost.add_cell(static_cast<double>(shapes.quality(k)));
  score.lengths = length_penalty(trial_.vertex());
  margins_.clear();
  for (const TestedFacet &facet : facets_) {
    const float margin = as_margin(facet_margin(facet.star));
    margins_.push_back(margin);
    score.cost.add_facet(static_cast<double>(margin));
    if (score.total() >= limit)
      return {};
  }
  return score;
}

/// Tries n places, step(k) away from where the vertex is, until visit(score) says that
/// it is enough. @returns whether it did
template <class Step, class Visit>
bool VolumeRelocation::try_places(int n, double floor, Step step, Visit visit) {
  const Vector<3> start = trial_.vertex().x;
  for (int k = 0; k < n; ++k) {
    const Vector<3> x = start + step(k);
    if (!place(x))
      continue;
    if (const std::optional<Score> score = evaluate(floor, no_limit);
        score && visit(*score))
      return true;
  }
  return false;
}

void VolumeRelocation::remember() {
  trial_.remember(best_.place);
  best_.margins.swap(margins_);
}

VolumeRelocation::Tried VolumeRelocation::here() {
  Tried now{trial_.here(), {}};
  for (const TestedFacet &facet : facets_)
    now.margins.push_back(state_.margins.at(facet.at));
  return now;
}

void VolumeRelocation::commit(const Tried &tried) {
  trial_.commit(tried.place);
  state_.changed.insert(state_.changed.end(), star_.begin(), star_.end());
  for (std::size_t k = 0; k < facets_.size(); ++k)
    state_.margins.put(facets_[k].at, tried.margins[k]);
}

/// Moves the vertex to where it is tried.
void VolumeRelocation::move_here() {
  remember();
  commit(best_);
}

bool VolumeRelocation::relocate(Index v, double radius, CounterRandom &random) {
  if (!gather(v))
    return false;
  const Score before = score_here();
  if (before.cost.failing == 0 && before.cost.shortfall <= 0)
    return false;
  const Matrix<3> L = lower_factor<3>(trial_.vertex().M);
  const double floor = floor_of(before.quality_min);
  const Vector<3> start = trial_.vertex().x;
  Vector<3> best = start;
  double best_total = before.total() - least_gain;
  bool found = false;
  for (int k = 0; k < n_candidates; ++k) {
    const Vector<3> step =
        in_space(L, radius * radius_fractions[k % 3] * random_in_ball(random));
    if (!place((k < 3 ? start : best) + step))
      continue;
    const std::optional<Score> score = evaluate(floor, best_total);
    if (!score)
      continue;
    remember();
    best = trial_.vertex().x;
    best_total = score->total() - least_gain;
    found = true;
  }
  if (found)
    commit(best_);
  return found;
}

bool VolumeRelocation::wander(Index v, double radius, CounterRandom &random) {
  if (!gather(v))
    return false;
  const Score before = score_here();
  const Matrix<3> L = lower_factor<3>(trial_.vertex().M);
  return try_places(
      n_wandering, floor_of(before.quality_min),
      [&](int) { return in_space(L, radius * random_in_ball(random)); },
      [&](const Score &score) {
        if (score.cost.failing > before.cost.failing + 1 ||
            score.lengths > std::max(before.lengths, most_wandering_penalty))
          return false;
        move_here();
        return true;
      });
}

bool VolumeRelocation::relocate_where(Index v, double radius, CounterRandom &random,
                                      const std::function<bool()> &accept) {
  if (!gather(v))
    return false;
  const Score before = score_here();
  const Tried from = here();
  const Matrix<3> L = lower_factor<3>(trial_.vertex().M);
  const std::size_t n_changed = state_.changed.size();
  return try_places(
      n_places, floor_of(before.quality_min),
      [&](int k) {
        return in_space(L, radius * (k + 1) / n_places * random_in_ball(random));
      },
      [&](const Score &score) {
        if (score.cost.failing > before.cost.failing ||
            score.lengths > before.lengths + least_gain)
          return false;
        move_here();
        if (accept())
          return true;
        commit(from);
        state_.changed.resize(n_changed);
        return false;
      });
}

/// Whether at the place no more facets fail and edges are no worse; they may come
/// nearer to it. The margins are kept.
bool VolumeRelocation::disagrees_no_more(const Score &before) {
  if (length_penalty(trial_.vertex()) > before.lengths + least_gain)
    return false;
  margins_.clear();
  int failing = 0;
  for (const TestedFacet &facet : facets_) {
    margins_.push_back(as_margin(facet_margin(facet.star)));
    failing += margins_.back() > 0;
    if (failing > before.cost.failing)
      return false;
  }
  return true;
}

bool VolumeRelocation::polish(Index v) {
  if (!gather_star(v))
    return false;
  const Vector<3> start = trial_.vertex().x;
  const Matrix<3> L = lower_factor<3>(trial_.vertex().M);
  const auto seen = [&](const Vector<3> &x) -> Vector<3> { return L.transpose() * x; };
  const Vector<3> step = ideal_step(volume_, v, star_, seen);
  if (step.squaredNorm() < smallest_polish * smallest_polish)
    return false;
  const double floor = floor_of(trial_.least_before());
  const double least_sum =
      trial_.sum_before() + polish_gain * static_cast<double>(star_.size());
  std::optional<Score> before; // few places are good enough to ask for it
  for (const double fraction : polish_fractions) {
    if (!place(start + in_space(L, fraction * step)))
      continue;
    const StarShapes &shapes = trial_.measure();
    if (shapes.minimum() < floor || shapes.minimum() <= 0 || shapes.sum() < least_sum)
      continue;
    if (!before) {
      gather_around();
      before = score_here();
    }
    if (!disagrees_no_more(*before))
      continue;
    move_here();
    return true;
  }
  return false;
}

} // namespace anistar
