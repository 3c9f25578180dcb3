#include "volume/stars/step_bounds.h"

namespace anistar {
namespace {

constexpr int max_sweeps = 10;
/// A projection goes so much further: it would only come near its bound.
constexpr double relaxation = 1.05;
/// What has a smaller slope, squared, does not depend on the step.
constexpr double smallest_square = 1e-12;

/// Facets with a margin above have a say.
constexpr double near_margin = -.08;
/// What is left of the margin of a facet that fails. More costs quality.
constexpr double wanted_margin = .003;
/// Cells with less above the floor have a say; they keep so much of it.
constexpr double near_floor = .15, kept_above_floor = .01;
/// Just inside of the range of unit lengths.
constexpr double shortest_kept = .72, longest_kept = 1.4;
/// Edges with less to these bounds have a say: they could cross them by one step.
constexpr double near_length = .35;
/// Bounds that are missed by less hold.
constexpr double tolerance = .001;
/// A step over which differences tell slopes.
constexpr double difference_step = 1e-3;

} // namespace

Vector<3> project(std::span<const LinearBound> bounds, const Vector<3> &wanted,
                  double radius) {
  Vector<3> y = wanted;
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    bool is_done = true;
    for (const LinearBound &bound : bounds) {
      const double excess = bound.excess(y);
      if (excess <= 0)
        continue;
      const double square = bound.slope.squaredNorm();
      if (square < smallest_square)
        continue;
      is_done = false;
      y -= std::min(relaxation * excess / square, radius / std::sqrt(square)) *
           bound.slope;
    }
    if (const double square = y.squaredNorm(); square > radius * radius)
      y *= radius / std::sqrt(square);
    if (is_done)
      break;
  }
  return y;
}

void StepBounds::begin(const Volume &volume, const MovingVertex &vertex) {
  bounds_.clear();
  const Vertex<3> &home = vertex.home();
  const Matrix<3> L = lower_factor<3>(home.M);
  const Index dimension = volume.feature(vertex.id());
  for (int k = 0; k < 3; ++k) {
    axes_.col(k) = anistar::in_space(L, Vector<3>::Unit(k));
    if (dimension == Triangulation<3>::interior)
      continue;
    const Vector<3> on = volume.surface.place(dimension, volume.support_of(vertex.id()),
                                              home.x + difference_step * axes_.col(k));
    axes_.col(k) = (on - home.x) / difference_step;
  }
}

void StepBounds::keep_facets(const MovingVertex &vertex) {
  for (const MovingVertex::TestedFacet &facet : vertex.facets()) {
    if (facet.here < near_margin)
      continue;
    const FacetSlope now = std::visit(
        [&](const auto &star) { return slope_of(star, &vertex.tried()); }, facet.star);
    const double kept =
        now.margin > 0 ? wanted_margin : .5 * std::min(-now.margin, wanted_margin);
    bounds_.push_back({now.margin + kept, now.gradient, now.margin > 0});
  }
}

/// The gradients are those with respect to the step.
FacetSlope StepBounds::slope_of(const FacetStar &star, const Vertex<3> *moved) const {
  const auto at = std::find(star.begin(), star.end(), moved);
  const FacetSlope slope = facet_slope(star, at - star.begin());
  return {slope.margin, axes_.transpose() * slope.gradient};
}

FacetSlope StepBounds::slope_of(const WallStar &star, const Vertex<3> *moved) const {
  Vertex<3> beside = *moved;
  const Vertex<3> *const there = &beside;
  WallStar changed = star;
  std::replace(changed.corners.begin(), changed.corners.end(), moved, there);
  std::replace(changed.apexes.begin(), changed.apexes.end(), moved, there);
  FacetSlope slope{margin_of(star), Vector<3>::Zero()};
  for (int k = 0; k < 3; ++k) {
    beside.x = moved->x + difference_step * axes_.col(k);
    slope.gradient[k] = (margin_of(changed) - slope.margin) / difference_step;
  }
  return slope;
}

bool StepBounds::give_up(const Vector<3> &y) {
  auto worst = bounds_.end();
  std::size_t n_wishes = 0;
  double largest = 0;
  bool is_missed = false;
  for (auto bound = bounds_.begin(); bound != bounds_.end(); ++bound) {
    const double excess = bound->excess(y);
    is_missed = is_missed || excess > tolerance;
    if (!bound->is_wish)
      continue;
    ++n_wishes;
    if (worst == bounds_.end() || excess > largest) {
      worst = bound;
      largest = excess;
    }
  }
  if (!is_missed || n_wishes < 2)
    return false;
  bounds_.erase(worst);
  return true;
}

void StepBounds::keep_qualities(const Volume &volume, MovingVertex &vertex,
                                double floor) {
  const double near = agreement_floor + near_floor;
  if (vertex.least_quality() >= near)
    return;
  const std::span<const Index> star = vertex.star();
  for (int k = 0; k < 3; ++k) {
    const StarShapes &moved =
        vertex.shapes_at(vertex.home().x + difference_step * axes_.col(k));
    std::vector<double> &slopes = quality_slopes_[k];
    slopes.resize(star.size());
    for (std::size_t i = 0; i < star.size(); ++i)
      slopes[i] = (static_cast<double>(moved.quality(i)) - volume.quality_of(star[i])) /
                  difference_step;
  }
  for (std::size_t i = 0; i < star.size(); ++i) {
    const double q = volume.quality_of(star[i]);
    if (q >= near)
      continue;
    const double least =
        q > floor + kept_above_floor ? floor + kept_above_floor : floor;
    bounds_.push_back(
        {least - q,
         {-quality_slopes_[0][i], -quality_slopes_[1][i], -quality_slopes_[2][i]}});
  }
}

void StepBounds::keep_lengths(const Volume &volume, const MovingVertex &vertex) {
  const Vertex<3> &home = vertex.home();
  const Matrix<3> L = lower_factor<3>(home.M);
  for (Index u : vertex.ring()) {
    const Vertex<3> &end = volume.mesh.vertex(u);
    const double length = fast_length(end, home);
    const Vector<3> away = in_metric(L, home.x - end.x).normalized();
    if (length > longest_kept - near_length)
      bounds_.push_back({std::min(length - longest_kept, 0.), away});
    if (length < shortest_kept + near_length)
      bounds_.push_back({std::min(shortest_kept - length, 0.), -away});
  }
}

} // namespace anistar
