#include "volume/passes/cell_swap.h"

namespace anistar {
namespace {

/// Longer rings gain nothing and cost the square of their length.
constexpr std::size_t longest_ring = 9;
/// What the worst cell must gain; where a cell is at rest less is not worth what it
/// undoes.
constexpr double any_gain = 1e-3, clear_gain = .02;

} // namespace

bool CellSwap::swap(Index c, VolumeCounts &counts) {
  const Cell<3> cell = volume_.mesh.at(c);
  gain_ = std::all_of(cell.begin(), cell.end(),
                      [&](Index v) { return volume_.is_at_rest(v); })
              ? clear_gain
              : any_gain;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      if (remove_edge(c, cell[i], cell[j])) {
        ++counts.edge_swaps;
        return true;
      } else if (volume_.is_put_off) {
        return false;
      }
  for (std::size_t i = 0; i < 4; ++i)
    if (swap_facet(HalfFacet(c, i))) {
      ++counts.face_swaps;
      return true;
    } else if (volume_.is_put_off) {
      return false;
    }
  return false;
}

/// Replaces a facet between two cells by the edge between their apices.
bool CellSwap::swap_facet(HalfFacet h) {
  const HalfFacet beyond = volume_.mesh.opposite(h);
  if (!beyond.exists() || volume_.mesh.constraint(h) != none)
    return false;
  if (volume_.slab && !volume_.is_inside(volume_.mesh.apex(beyond))) {
    volume_.is_put_off = true;
    return false;
  }
  const std::array<Index, 2> both{h.cell(), beyond.cell()};
  return operator_.replace(both, volume_.mesh.apex(h), {none, none},
                           improvement(gain_));
}

bool CellSwap::remove_edge(Index c, Index a, Index b) {
  const auto walls = walls_of_removable(volume_, c, a, b, longest_ring, shell_);
  if (!walls || !is_ring_inside())
    return false;
  double worst = 1;
  for (Index cell : shell_.all())
    worst = std::min(worst, volume_.quality_of(cell));
  const double threshold = better_by(gain_, worst);
  for (std::size_t k = 0; k < shell_.n_ring(); ++k) {
    if (!walls->admits_apex(k) || !is_ring_better(k, threshold))
      continue;
    if (operator_.replace(shell_.all(), shell_.ring[k], {a, b},
                          improvement(gain_, hausdorff_number_)))
      return true;
    if (volume_.is_put_off)
      return false;
  }
  return false;
}

/// Else the edge is put off.
bool CellSwap::is_ring_inside() {
  if (volume_.slab)
    for (std::size_t k = 0; k < shell_.n_ring(); ++k)
      if (!volume_.is_inside(shell_.ring[k])) {
        volume_.is_put_off = true;
        return false;
      }
  return true;
}

/// Whether no cell is below a threshold when the ring of the shell is joined to one of
/// its vertices.
bool CellSwap::is_ring_better(std::size_t apex, double threshold) const {
  const Triangulation<3> &mesh = volume_.mesh;
  const Vertex<3> &a = mesh.vertex(shell_.a), &b = mesh.vertex(shell_.b);
  const std::size_t n = shell_.n_ring();
  const Vertex<3> &r = mesh.vertex(shell_.ring[apex]);
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const std::size_t i = (apex + k) % n, j = (apex + k + 1) % n;
    if (!shell_.is_closed && j == 0)
      continue; // an open ring has a gap there
    const Vertex<3> &c = mesh.vertex(shell_.ring[i]), &e = mesh.vertex(shell_.ring[j]);
    if (shape_quality(a, r, c, e) < threshold || shape_quality(r, b, c, e) < threshold)
      return false;
  }
  return true;
}

} // namespace anistar
