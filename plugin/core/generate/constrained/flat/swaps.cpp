#include "generate/constrained/flat/swaps.h"

#include "generate/constrained/points/cell_shape.h"
#include "generate/constrained/regions/regions.h"

#include <algorithm>
#include <limits>

namespace anistar::generate {
namespace {

/// What a swap must gain at least, as a factor, and reach.
constexpr double least_gain = 10, least_swapped = 1e-8;

/// A polygon round an edge, counter-clockwise seen from its top, and how it is cut.
class Fan {
public:
  Fan(const ExactPoints &points, std::vector<Index> ring, Index bottom, Index top)
      : points_(points), ring_(std::move(ring)), bottom_(bottom), top_(top) {}

  /// The cells below and above the best triangles.
  std::vector<Cell<3>> best_cells() {
    const std::size_t n = ring_.size();
    least_.assign(n * n, std::numeric_limits<double>::infinity());
    corner_.assign(n * n, 0);
    for (std::size_t width = 2; width < n; ++width)
      for (std::size_t i = 0; i + width < n; ++i)
        choose(i, i + width);
    std::vector<Cell<3>> cells;
    collect(0, n - 1, cells);
    return cells;
  }

private:
  const ExactPoints &points_;
  std::vector<Index> ring_;
  Index bottom_, top_;
  std::vector<double> least_; ///< of the shapes over the chain from i to k
  std::vector<std::size_t>
      corner_; ///< the third corner of the triangle at chord (i, k)

  [[nodiscard]] std::size_t at(std::size_t i, std::size_t k) const {
    return i * ring_.size() + k;
  }
  [[nodiscard]] std::array<Cell<3>, 2> cells_at(std::size_t i, std::size_t j,
                                                std::size_t k) const {
    return {{{ring_[i], ring_[j], ring_[k], top_},
             {ring_[j], ring_[i], ring_[k], bottom_}}};
  }
  void choose(std::size_t i, std::size_t k) {
    least_[at(i, k)] = -std::numeric_limits<double>::infinity();
    for (std::size_t j = i + 1; j < k; ++j) {
      const auto [above, below] = cells_at(i, j, k);
      const double least =
          std::min({least_[at(i, j)], least_[at(j, k)], shape_of(points_, above),
                    shape_of(points_, below)});
      if (least > least_[at(i, k)]) {
        least_[at(i, k)] = least;
        corner_[at(i, k)] = j;
      }
    }
  }
  void collect(std::size_t i, std::size_t k, std::vector<Cell<3>> &cells) const {
    if (k - i < 2)
      return;
    const std::size_t j = corner_[at(i, k)];
    if (j == 0)
      return; // all are NaN or of infinite size: what is left out does not pass the
              // check
    for (const Cell<3> &cell : cells_at(i, j, k))
      cells.push_back(cell);
    collect(i, j, cells);
    collect(j, k, cells);
  }
};

} // namespace

bool is_worth(const Swap &swap) {
  return swap.least_after > least_swapped &&
         swap.least_after > least_gain * swap.least_before;
}

std::optional<Swap> checked(const ExactPoints &points, const GhostMesh &mesh,
                            std::vector<Index> old, std::vector<Cell<3>> cells) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Swap swap{std::move(old), std::move(cells), infinity, infinity};
  for (const Index c : swap.old)
    swap.least_before = std::min(swap.least_before, shape_of(points, mesh.cell(c)));
  for (const Cell<3> &cell : swap.cells) {
    swap.least_after = std::min(swap.least_after, shape_of(points, cell));
    if (points.orientation(cell[0], cell[1], cell[2], cell[3]) != Orientation::positive)
      return std::nullopt;
  }
  return swap;
}

std::optional<Swap> Swaps::without_edge(Index a, Index b) {
  const auto place = mesh_.find_edge(a, b);
  if (!place)
    return std::nullopt;
  mesh_.ring(*place, ring_);
  if (ring_.size() < 3 || ring_.size() > most_round_edge || !is_free(ring_, a, b))
    return std::nullopt;
  std::vector<Index> old, corners;
  for (const HalfFacet leave : ring_) {
    old.push_back(leave.cell());
    corners.push_back(mesh_.apex(leave));
  }
  if (points_.orientation(a, b, corners[0], corners[1]) == Orientation::negative)
    std::swap(a, b);
  auto cells = Fan(points_, corners, a, b).best_cells();
  if (cells.size() != 2 * (corners.size() - 2))
    return std::nullopt;
  return checked(points_, mesh_, std::move(old), std::move(cells));
}

/// Whether the edge is inside of one region and on no wall.
bool Swaps::is_free(const std::vector<HalfFacet> &ring, Index a, Index b) const {
  const Index region = regions_[ring.front().cell()];
  return region != outside && std::ranges::all_of(ring, [&](HalfFacet leave) {
           const Index c = leave.cell();
           for (std::size_t i = 0; i < 4; ++i)
             if (mesh_.cell(c)[i] != a && mesh_.cell(c)[i] != b &&
                 mesh_.wall({c, i}) != none)
               return false;
           return regions_[c] == region;
         });
}

std::optional<Swap> Swaps::without_facet(HalfFacet h) const {
  const HalfFacet other = mesh_.opposite(h);
  if (mesh_.wall(h) != none || regions_[h.cell()] == outside ||
      regions_[h.cell()] != regions_[other.cell()])
    return std::nullopt;
  const auto [a, b, c] = mesh_.facet(h);
  const Index above = mesh_.apex(h), below = mesh_.apex(other);
  std::vector<Cell<3>> cells;
  for (const auto &[u, v] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
    cells.push_back({below, u, v, above});
  return checked(points_, mesh_, {h.cell(), other.cell()}, std::move(cells));
}

std::vector<Segment> Swaps::edges_about(Index c) {
  std::vector<Segment> found;
  const Cell<3> &cell = mesh_.cell(c);
  const auto note = [&](const Cell<3> &beside) {
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        found.push_back(
            {std::min(beside[i], beside[j]), std::max(beside[i], beside[j])});
  };
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      mesh_.ring({cell[i], cell[j], c}, ring_);
      for (const HalfFacet leave : ring_)
        if (regions_[leave.cell()] != outside)
          note(mesh_.cell(leave.cell()));
    }
  std::ranges::sort(found);
  const auto rest = std::ranges::unique(found);
  found.erase(rest.begin(), rest.end());
  return found;
}

} // namespace anistar::generate
