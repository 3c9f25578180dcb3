#include "surface/matched_ridges.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace anistar {
namespace {

/// A point lies on a ridge when it is this near, relative to its shortest edge. Others
/// that are no ridge points keep an edge's length from it.
constexpr double on_ridge = 1e-3;
/// A sharp fold is a ridge if the geometry has one this near, relative to its length: a
/// surface may be sampled too badly to tell by itself.
constexpr double farthest_ridge = .25;

using Edge = std::array<Index, 2>;

Edge sorted(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// The lengths of the shortest folds at the points, infinite where there is none.
std::vector<double> shortest_edges(std::span<const Vector<3>> points,
                                   std::span<const Fold> folds,
                                   std::span<const Edge> others) {
  std::vector<double> shortest(points.size(), std::numeric_limits<double>::infinity());
  const auto consider = [&](const Edge &ends) {
    const double length = (points[ends[1]] - points[ends[0]]).norm();
    for (Index v : ends) {
      double &here = shortest[v];
      here = std::min(here, length);
    }
  };
  for (const Fold &fold : folds)
    consider(fold.ends);
  for (const Edge &edge : others)
    consider(edge);
  return shortest;
}

/// A step along a curve from one point of the mesh to the next.
struct Step {
  Edge ends;
  Index curve;
};

std::vector<Step> steps_along(const SmoothSurface &geometry,
                              std::span<const Vector<3>> points,
                              const std::vector<double> &shortest) {
  struct Stop {
    Index curve;
    double position;
    Index point;
  };
  std::vector<Stop> stops;
  const CurvedPieces *ridges = geometry.ridge(false, 0);
  for (std::size_t v = 0; ridges && v < points.size(); ++v) {
    if (!std::isfinite(shortest[v]))
      continue;
    const auto found = ridges->find(points[v], on_ridge * shortest[v]);
    if (found)
      for (const auto &[curve, position] :
           geometry.chains().places(found->piece, 1 - found->weights[0]))
        stops.push_back({curve, position, static_cast<Index>(v)});
  }
  std::sort(stops.begin(), stops.end(), [](const Stop &a, const Stop &b) {
    return std::tie(a.curve, a.position, a.point) <
           std::tie(b.curve, b.position, b.point);
  });
  std::vector<Step> steps;
  for (std::size_t begin = 0, end = 0; begin < stops.size(); begin = end) {
    while (end < stops.size() && stops[end].curve == stops[begin].curve)
      ++end;
    const Index curve = stops[begin].curve;
    for (std::size_t k = begin + 1; k < end; ++k)
      steps.push_back({sorted(stops[k - 1].point, stops[k].point), curve});
    if (geometry.chains().is_closed(curve))
      steps.push_back({sorted(stops[begin].point, stops[end - 1].point), curve});
  }
  return steps;
}

/// Finds the edges of a mesh by their ends.
class EdgeTable {
public:
  EdgeTable(std::span<const Fold> folds, std::span<const Edge> others)
      : folds_(folds), others_(others.begin(), others.end()) {}

  [[nodiscard]] std::optional<std::size_t> fold(const Edge &ends) const {
    const auto at = std::lower_bound(
        folds_.begin(), folds_.end(), ends,
        [](const Fold &fold, const Edge &wanted) { return fold.ends < wanted; });
    if (at == folds_.end() || at->ends != ends)
      return std::nullopt;
    return static_cast<std::size_t>(at - folds_.begin());
  }
  [[nodiscard]] bool contains(const Edge &ends) const {
    return fold(ends).has_value() || others_.contains(ends);
  }

private:
  std::span<const Fold> folds_; ///< sorted
  std::set<Edge> others_;
};

/// The curves that the edges of a mesh do not follow.
FeatureSet strange_curves(const std::vector<Step> &steps, const EdgeTable &edges,
                          std::size_t n_curves) {
  FeatureSet is_strange(n_curves);
  std::fill(is_strange.begin(), is_strange.end(), std::uint8_t{1});
  for (const Step &step : steps)
    is_strange[step.curve] = 0;
  for (const Step &step : steps)
    if (!edges.contains(step.ends))
      is_strange[step.curve] = 1;
  return is_strange;
}

} // namespace

std::vector<bool> matched_ridges(const SmoothSurface &geometry,
                                 std::span<const Vector<3>> points,
                                 std::span<const Fold> folds,
                                 std::span<const Edge> others,
                                 const std::vector<bool> &is_sharp) {
  const std::vector<Step> steps =
      steps_along(geometry, points, shortest_edges(points, folds, others));
  const EdgeTable edges(folds, others);
  const FeatureSet is_strange = strange_curves(steps, edges, geometry.n_curves());
  std::vector<bool> is_ridge(folds.size(), false);
  for (const Step &step : steps)
    if (is_strange[step.curve] == 0)
      if (const auto k = edges.fold(step.ends))
        is_ridge[*k] = true;
  for (std::size_t k = 0; k < folds.size(); ++k) {
    if (is_ridge[k] || !is_sharp[k])
      continue;
    const Vector<3> &x = points[folds[k].ends[0]], &y = points[folds[k].ends[1]];
    is_ridge[k] = geometry.distance_to_ridges(.5 * (x + y), is_strange) <=
                  farthest_ridge * (y - x).norm();
  }
  return is_ridge;
}

} // namespace anistar
