#include "metric/pieces.h"

#include <cmath>

namespace anistar {
namespace {

/// Gives every edge of every cell to visit(a, b), those between cells more than once.
template <std::size_t d, class Visit>
void visit_edges(std::span<const Cell<d>> cells, Visit visit) {
  for (const Cell<d> &cell : cells)
    for (std::size_t i = 0; i <= d; ++i)
      for (std::size_t j = 0; j < i; ++j)
        visit(cell[i], cell[j]);
}

} // namespace

template <std::size_t d>
Pieces pieces_at(std::span<const Vector<d>> points, std::span<const Cell<d>> cells,
                 std::span<const SymmetricTensor<d>> metric) {
  std::vector<double> most(points.size(), 1);
  visit_edges<d>(cells, [&](std::size_t a, std::size_t b) {
    const Vector<d> v = points[b] - points[a];
    for (std::size_t end : {a, b})
      most[end] = std::max(most[end], quadratic<d>(metric[end], v));
  });
  for (double &square : most)
    square = std::sqrt(square);
  std::vector<double> fewest = most;
  visit_edges<d>(cells, [&](std::size_t a, std::size_t b) {
    fewest[a] = std::min(fewest[a], most[b]);
    fewest[b] = std::min(fewest[b], most[a]);
  });
  return {std::move(most), std::move(fewest)};
}

template Pieces pieces_at<2>(std::span<const Vector<2>>, std::span<const Cell<2>>,
                             std::span<const SymmetricTensor<2>>);
template Pieces pieces_at<3>(std::span<const Vector<3>>, std::span<const Cell<3>>,
                             std::span<const SymmetricTensor<3>>);

} // namespace anistar
