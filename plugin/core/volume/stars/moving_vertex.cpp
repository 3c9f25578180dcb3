#include "volume/stars/moving_vertex.h"

namespace anistar {
namespace {

/// Edges outside of this range are penalised, short ones more: they cost vertices.
constexpr double shortest_free = .58, longest_free = 1.65;
constexpr double short_weight = 10, long_weight = 4;
/// What edges may become worse by, for round-off.
constexpr double round_off = 1e-9;
/// Facets with a margin above decide about most places: they are tested first.
constexpr double critical_margin = -.03;

} // namespace

bool MovingVertex::gather_star(Index v) {
  if (volume_.feature(v) == Triangulation<3>::corner)
    return false;
  v_ = v;
  star_of(volume_, v, star_);
  return trial_.gather(v, star_);
}

bool MovingVertex::gather_around() {
  const Triangulation<3> &mesh = volume_.mesh;
  facets_.clear();
  safe_.clear();
  ring_.clear();
  failing_facets_ = 0;
  take_home_normals();
  volume_.open_vertices();
  volume_.mark_vertex(v_);
  for (Index c : star_) {
    const std::size_t at = mesh.local_index(c, v_);
    for (Index u : facet_of<3>(mesh.at(c), at))
      if (volume_.mark_vertex(u))
        ring_.push_back(u);
    if (!gather_facets(c, at))
      return false;
  }
  gather_far_violations();
  facets_.insert(facets_.end(), safe_.begin(), safe_.end());
  return true;
}

/// The facets of a cell of the star; those at v from one of their cells only.
/// @param at where v is in the cell
bool MovingVertex::gather_facets(Index c, std::size_t at) {
  const Triangulation<3> &mesh = volume_.mesh;
  for (std::size_t i = 0; i < 4; ++i) {
    const HalfFacet h(c, i), other = mesh.opposite(h);
    if (other.exists() && i != at && other.cell() < c)
      continue;
    if (volume_.slab && other.exists() && !volume_.is_inside(mesh.apex(other))) {
      volume_.is_put_off = true;
      return false;
    }
    add(h, deciding_star(mesh, view_.state.normals, h),
        static_cast<double>(view_.state.margins.at(h)));
  }
  return true;
}

void MovingVertex::gather_far_violations() {
  for (const FarViolation &violation : view_.state.far.at(v_)) {
    const DecidingStar star = star_of(volume_.mesh, view_.state.normals, violation);
    add(HalfFacet(), star, margin_of(star));
  }
}

void MovingVertex::add(HalfFacet at, const DecidingStar &star, double here) {
  failing_facets_ += at.exists() && here > 0;
  TestedFacet &facet = (here > critical_margin ? facets_ : safe_)
                           .emplace_back(TestedFacet{at, star, here});
  std::visit([&](auto &of_home) { put_trial_in(of_home); }, facet.star);
}

void MovingVertex::put_trial_in(FacetStar &star) const {
  const Vertex<3> *const from = &home(), *const to = &trial_.vertex();
  std::replace(star.begin(), star.end(), from, to);
}

void MovingVertex::put_trial_in(WallStar &star) const {
  const Vertex<3> *const from = &home(), *const to = &trial_.vertex();
  std::replace(star.apexes.begin(), star.apexes.end(), from, to);
  std::replace(star.corners.begin(), star.corners.end(), from, to);
  const auto at_home = view_.state.normals.at(v_);
  for (std::size_t n = 0; n < normals_.size(); ++n) {
    const Vector<3> *const before = &at_home[n].along, *const tried =
                                                           &normals_[n].along;
    std::replace(star.normals.begin(), star.normals.end(), before, tried);
  }
}

void MovingVertex::take_home_normals() {
  const auto at_home = view_.state.normals.at(v_);
  normals_.assign(at_home.begin(), at_home.end());
}

/// Finds the normals of curved surfaces where the vertex is tried.
void MovingVertex::take_normals() {
  const Vector<3> &found = trial_.surface_normal();
  for (auto &[patch, along] : normals_)
    along = found.isZero(0) ? volume_.surface.normal(patch, trial_.vertex().x, along)
                            : found;
}

PlaceScore MovingVertex::score_here() const {
  PlaceScore score;
  for (Index c : star_)
    score.cost.add_cell(volume_.quality_of(c));
  score.quality_min = trial_.least_before();
  for (const TestedFacet &facet : facets_)
    score.cost.add_facet(facet.here);
  score.lengths = length_penalty(home());
  return score;
}

double MovingVertex::length_penalty(const Vertex<3> &at) const {
  double penalty = 0;
  for (Index u : ring_) {
    const double l = fast_length(volume_.mesh.vertex(u), at);
    penalty += short_weight * std::max(0., shortest_free - l) +
               long_weight * std::max(0., l - longest_free);
  }
  return penalty;
}

/// Puts the vertex there, with the metric that it has at home.
bool MovingVertex::put(const Vector<3> &x) {
  trial_.place(x);
  return is_in_range<3>(trial_.vertex().x) && trial_.is_positive();
}

bool MovingVertex::place(const Vector<3> &x) {
  if (!put(x))
    return false;
  trial_.take_metric();
  ++trials_;
  return true;
}

bool MovingVertex::place(const Vector<3> &x, const ShapeDemand &demand) {
  if (!put(x))
    return false;
  ++trials_;
  // to find the metric takes longer than the shapes, and it is about that of home
  if (!demand.is_met_by(trial_.measure()))
    return false;
  trial_.take_metric();
  return demand.is_met_by(trial_.measure());
}

std::optional<PlaceScore> MovingVertex::evaluate(double floor, double limit) {
  const StarShapes &shapes = trial_.measure();
  PlaceScore score;
  score.quality_min = shapes.minimum();
  if (score.quality_min < floor || score.quality_min <= 0)
    return {};
  for (std::size_t k = 0; k < star_.size(); ++k)
    score.cost.add_cell(static_cast<double>(shapes.quality(k)));
  score.lengths = length_penalty(trial_.vertex());
  if (score.total() >= limit)
    return {};
  take_normals();
  margins_.clear();
  int failing_facets = 0;
  for (const TestedFacet &facet : facets_) {
    margins_.push_back(margin_of(facet.star));
    score.cost.add_facet(margins_.back());
    failing_facets += facet.at.exists() && margins_.back() > 0;
    if (score.total() >= limit)
      return {};
  }
  if (failing_facets > failing_facets_ && !view_.state.far.empty())
    return {};
  // this takes longer than all the rest
  return trial_.keeps_surfaces() ? std::optional(score) : std::nullopt;
}

bool MovingVertex::disagrees_no_more(const PlaceScore &before) {
  if (length_penalty(trial_.vertex()) > before.lengths + round_off)
    return false;
  take_normals();
  margins_.clear();
  int failing = 0;
  for (const TestedFacet &facet : facets_) {
    margins_.push_back(margin_of(facet.star));
    failing += margins_.back() > 0;
    if (failing > before.cost.failing)
      return false;
  }
  return trial_.keeps_surfaces();
}

void MovingVertex::remember() {
  trial_.remember(best_);
  best_margins_.swap(margins_);
  best_normals_.assign(normals_.begin(), normals_.end());
}

void MovingVertex::move_to_best() {
  trial_.commit(best_);
  view_.changed.insert(view_.changed.end(), star_.begin(), star_.end());
  view_.state.normals.put(v_, best_normals_);
  view_.more_failing -= failing_facets_;
  for (std::size_t k = 0; k < facets_.size(); ++k)
    if (facets_[k].at.exists()) {
      view_.state.margins.put(facets_[k].at, as_margin(best_margins_[k]));
      view_.more_failing += best_margins_[k] > 0;
    }
  PerVertex<std::uint8_t> &is_stuck = view_.state.is_stuck;
  is_stuck[v_] = 0;
  for (Index u : ring_)
    is_stuck[u] = 0;
}

} // namespace anistar
