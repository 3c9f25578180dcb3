#include "search/locator.h"

#include "base/predicates.h"
#include "base/range.h"
#include "mesh/hilbert.h"
#include "search/nearest_on.h"

#include <algorithm>

namespace anistar {
namespace {

/// A walk from a good hint takes a handful of steps; one that takes more is on a mesh
/// where it may cycle, and the tree answers instead.
constexpr int max_walk_steps = 64;

template <std::size_t d>
std::vector<HalfFacet> boundary_facets(const std::vector<Neighbours<d>> &neighbours) {
  std::vector<HalfFacet> out;
  for (std::size_t c = 0; c < neighbours.size(); ++c)
    for (std::size_t i = 0; i <= d; ++i)
      if (!neighbours[c][i].exists())
        out.emplace_back(static_cast<Index>(c), i);
  return out;
}

template <std::size_t d>
std::vector<Box<d>> facet_boxes(std::span<const Vector<d>> points,
                                std::span<const Cell<d>> cells,
                                const std::vector<HalfFacet> &facets) {
  std::vector<Box<d>> boxes(facets.size());
  for (std::size_t k = 0; k < facets.size(); ++k)
    for (Index v : facet_of<d>(cells[facets[k].cell()], facets[k].facet()))
      boxes[k].extend(points[v]);
  return boxes;
}

} // namespace

template <std::size_t d>
Locator<d>::Locator(std::span<const Vector<d>> points, std::span<const Cell<d>> cells,
                    int threads)
    : points_(points.begin(), points.end()), cells_(cells.begin(), cells.end()),
      neighbours_(adjacency<d>(cells, points.size())), threads_(threads) {}

template <std::size_t d> const BoxTree<d> &Locator<d>::cell_tree() const {
  const auto box_of = [&](std::size_t c) {
    Box<d> box;
    for (Index v : cells_[c])
      box.extend(points_[v]);
    return box;
  };
  return cell_tree_.get([&] { return BoxTree<d>(cells_.size(), box_of, threads_); });
}

template <std::size_t d>
const typename Locator<d>::Boundary &Locator<d>::boundary() const {
  return boundary_.get([&] {
    std::vector<HalfFacet> facets = boundary_facets<d>(neighbours_);
    BoxTree<d> tree(facet_boxes<d>(points_, cells_, facets));
    return Boundary{std::move(facets), std::move(tree)};
  });
}

template <std::size_t d> Simplex<d> Locator<d>::simplex(Index cell) const {
  Simplex<d> s;
  for (std::size_t i = 0; i <= d; ++i)
    s[i] = points_[cells_[cell][i]];
  return s;
}

/// A visibility walk that remembers where it came from; `none` when it meets the
/// boundary or its bound.
template <std::size_t d> Index Locator<d>::walk(const Vector<d> &x, Index start) const {
  Index cell = start, previous = none;
  for (int step = 0; step < max_walk_steps; ++step) {
    const Simplex<d> corners = simplex(cell);
    Index next = none;
    bool crossed = false;
    for (std::size_t k = 0; k <= d && !crossed; ++k) {
      const std::size_t i = (k + step) % (d + 1);
      const Index beyond = neighbours_[cell][i].cell();
      if (beyond == previous && beyond != none)
        continue;
      Simplex<d> replaced = corners;
      replaced[i] = x;
      if (orientation<d>(replaced) == Orientation::negative) {
        next = beyond;
        crossed = true;
      }
    }
    if (!crossed)
      return cell;
    if (next == none)
      return none;
    previous = cell;
    cell = next;
  }
  return none;
}

template <std::size_t d> Index Locator<d>::containing(const Vector<d> &x) const {
  Index found = none;
  cell_tree().meeting(Box<d>{x, x}, [&](Index cell) {
    const Simplex<d> corners = simplex(cell);
    for (std::size_t i = 0; i <= d; ++i) {
      Simplex<d> replaced = corners;
      replaced[i] = x;
      if (orientation<d>(replaced) == Orientation::negative)
        return true;
    }
    found = cell;
    return false;
  });
  return found;
}

template <std::size_t d>
Location<d> Locator<d>::inside(const Vector<d> &x, Index cell) const {
  const Simplex<d> corners = simplex(cell);
  Location<d> at{cell, {}, 0};
  double sum = 0;
  for (std::size_t i = 0; i <= d; ++i) {
    Simplex<d> replaced = corners;
    replaced[i] = x;
    at.barycentric[i] = std::max(0., volume_determinant<d>(replaced));
    sum += at.barycentric[i];
  }
  if (!(sum > 0)) { // the cell is flat in double precision
    at.barycentric.fill(1);
    sum = static_cast<double>(d + 1);
  }
  for (double &b : at.barycentric)
    b /= sum;
  return at;
}

template <std::size_t d> Location<d> Locator<d>::nearest(const Vector<d> &x) const {
  Location<d> best;
  double best_distance = std::numeric_limits<double>::infinity();
  const Boundary &boundary = this->boundary();
  boundary.tree.nearest(x, best_distance, [&](Index item, double) {
    const HalfFacet half = boundary.facets[item];
    const Cell<d> &cell = cells_[half.cell()];
    const Facet<d> facet = facet_of<d>(cell, half.facet());
    std::array<Vector<d>, d> corners;
    for (std::size_t i = 0; i < d; ++i)
      corners[i] = points_[facet[i]];
    const std::array<double, d> weights = nearest_on(x, corners);
    Vector<d> foot = Vector<d>::Zero();
    for (std::size_t i = 0; i < d; ++i)
      foot += weights[i] * corners[i];
    const double distance = (foot - x).squaredNorm();
    if (distance < best_distance ||
        (distance == best_distance && half.cell() < best.cell)) {
      best_distance = distance;
      best.cell = half.cell();
      best.barycentric.fill(0);
      for (std::size_t i = 0; i < d; ++i)
        best.barycentric[std::find(cell.begin(), cell.end(), facet[i]) - cell.begin()] =
            weights[i];
    }
    return best_distance;
  });
  best.distance = std::sqrt(best_distance);
  return best;
}

template <std::size_t d>
Location<d> Locator<d>::locate(const Vector<d> &x, Index hint) const {
  if (!is_in_range<d>(x)) // nothing is nearest to it, and its cell would be `none`
    throw out_of_range("a point to locate is out of range", x);
  Index cell = hint == none ? none : walk(x, hint);
  if (cell == none)
    cell = containing(x);
  return cell == none ? nearest(x) : inside(x, cell);
}

template <std::size_t d>
std::vector<Location<d>>
Locator<d>::locate_all(std::span<const Vector<d>> queries) const {
  std::vector<Location<d>> out(queries.size());
  Index hint = none;
  for (Index k : hilbert_order<d>(queries)) {
    const std::size_t q = k;
    out[q] = locate(queries[q], hint);
    hint = out[q].cell;
  }
  return out;
}

template class Locator<2>;
template class Locator<3>;

} // namespace anistar
