#include "search/nearest.h"

#include "search/box_tree.h"

#include <cmath>

namespace anistar {
namespace {

/// Half the size of the box around the unit ball of a metric: the roots of the diagonal
/// of its inverse.
template <std::size_t d> Vector<d> ball_extent(const SymmetricTensor<d> &M) {
  return as_matrix<d>(M).inverse().diagonal().cwiseMax(0).cwiseSqrt();
}

} // namespace

template <std::size_t d>
std::vector<Index> nearest_in_metric(std::span<const Vector<d>> points,
                                     std::span<const Vector<d>> queries,
                                     std::span<const SymmetricTensor<d>> metrics,
                                     std::span<const Index> seeds) {
  std::vector<Box<d>> boxes(points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    boxes[k].extend(points[k]);
  const BoxTree<d> tree(boxes);
  std::vector<Index> nearest(seeds.begin(), seeds.end());
  for (std::size_t q = 0; q < queries.size(); ++q) {
    const auto squared_distance = [&](Index item) {
      return quadratic<d>(metrics[q], points[item] - queries[q]);
    };
    double best = squared_distance(nearest[q]);
    const Vector<d> reach = std::sqrt(best) * ball_extent<d>(metrics[q]);
    tree.meeting(Box<d>{queries[q] - reach, queries[q] + reach}, [&](Index item) {
      const double distance = squared_distance(item);
      if (distance < best || (distance == best && item < nearest[q])) {
        best = distance;
        nearest[q] = item;
      }
      return true;
    });
  }
  return nearest;
}

template std::vector<Index> nearest_in_metric<2>(std::span<const Vector<2>>,
                                                 std::span<const Vector<2>>,
                                                 std::span<const SymmetricTensor<2>>,
                                                 std::span<const Index>);
template std::vector<Index> nearest_in_metric<3>(std::span<const Vector<3>>,
                                                 std::span<const Vector<3>>,
                                                 std::span<const SymmetricTensor<3>>,
                                                 std::span<const Index>);

} // namespace anistar
