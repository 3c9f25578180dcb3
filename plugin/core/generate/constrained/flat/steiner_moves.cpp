#include "generate/constrained/flat/steiner_moves.h"

#include "generate/constrained/points/cell_shape.h"
#include "generate/constrained/regions/regions.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace anistar::generate {
namespace {

/// How far a point is moved, in lengths of its shortest edge.
constexpr double steps[] = {.5, .25, .12, .06, .03, -.03, -.06, -.12, -.25, -.5};
/// What a move must gain at least, as a factor, and reach.
constexpr double least_gain = 10, least_moved = 1e-12;

} // namespace

SteinerMoves::SteinerMoves(ExactPoints &points, const GhostMesh &mesh,
                           const PerCell<Index> &regions)
    : points_(points), mesh_(mesh), regions_(regions), is_end_(points.size(), false) {
  for (const SteinerPoint &point : points.steiner_points())
    is_end_[point.a] = is_end_[point.b] = true;
}

bool SteinerMoves::improve(Index c) {
  const Cell<3> cell = mesh_.cell(c);
  return std::ranges::any_of(cell, [this](Index v) {
    return v >= points_.n_given() && !is_end_[v] && move(v);
  });
}

bool SteinerMoves::move(Index v) {
  const SteinerPoint before = points_.steiner(v);
  const double length = std::sqrt(points_.squared_distance(before.a, before.b));
  const double reach = shortest_edge(v) / length;
  const double old = least_shape(v);
  double best = std::max(least_moved, least_gain * old), best_t = before.t;
  for (const double step : steps) {
    const double t = before.t + step * reach;
    if (!(t > 0 && t < 1))
      continue;
    points_.move(v, t);
    const double shape = least_shape(v);
    if (shape > best) {
      best = shape;
      best_t = t;
    }
  }
  points_.move(v, best_t);
  return best_t != before.t;
}

double SteinerMoves::shortest_edge(Index v) const {
  double shortest = std::numeric_limits<double>::infinity();
  for (const Index c : mesh_.star(v))
    for (const Index other : mesh_.cell(c))
      if (other != v && other != ghost)
        shortest = std::min(shortest, points_.squared_distance(v, other));
  return std::sqrt(shortest);
}

double SteinerMoves::least_shape(Index v) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Index c : mesh_.star(v))
    if (regions_[c] != outside)
      least = std::min(least, shape_of(points_, mesh_.cell(c)));
  return least;
}

} // namespace anistar::generate
