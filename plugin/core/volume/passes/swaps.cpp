#include "volume/passes/slab_team.h"

namespace anistar {
namespace {

/// Longer rings gain nothing and cost the square of their length.
constexpr std::size_t longest_ring = 9;
constexpr double swap_gain = 1e-3;

} // namespace

void VolumePasses::swap(double quality) {
  const std::uint32_t since = begin(Pass::swap);
  const auto is_due = [&](Index c) {
    return volume_.mesh.is_alive(c) && volume_.quality_of(c) <= quality &&
           volume_.cell_clock[c] >= since;
  };
  std::vector<Index> cells;
  for (std::size_t k = 0; k < volume_.mesh.cells.size(); ++k)
    if (is_due(static_cast<Index>(k)))
      cells.push_back(static_cast<Index>(k));
  in_slabs(
      std::move(cells),
      [&](Index c, int round) {
        return volume_.state.slabs.of_cell(volume_.mesh.at(c), round);
      },
      [=](VolumePasses &passes, Index c) {
        if (is_due(c))
          (void)passes.swap_cell(c);
      });
}

bool VolumePasses::swap_cell(Index c) {
  const Cell<3> cell = volume_.mesh.at(c);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      if (remove_edge(c, cell[i], cell[j])) {
        ++counts_.edge_swaps;
        return true;
      } else if (volume_.is_put_off) {
        return false;
      }
  for (std::size_t i = 0; i < 4; ++i) {
    const HalfFacet h(c, i), beyond = volume_.mesh.opposite(h);
    if (!beyond.exists() || volume_.mesh.constraint(h) != none)
      continue;
    if (volume_.slab && !volume_.is_inside(volume_.mesh.apex(beyond))) {
      volume_.is_put_off = true;
      return false;
    }
    const std::array<Index, 2> both{c, beyond.cell()};
    if (operator_.replace(both, cell[i], {none, none}, improvement(swap_gain))) {
      ++counts_.face_swaps;
      return true;
    }
    if (volume_.is_put_off)
      return false;
  }
  return false;
}

bool VolumePasses::is_ring_better(std::size_t apex, double threshold) const {
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

bool VolumePasses::remove_edge(Index c, Index a, Index b) {
  const auto walls = walls_of_removable(volume_, c, a, b, longest_ring, shell_);
  if (!walls)
    return false;
  const std::size_t n = shell_.n_ring();
  if (volume_.slab)
    for (std::size_t k = 0; k < n; ++k)
      if (!volume_.is_inside(shell_.ring[k])) {
        volume_.is_put_off = true;
        return false;
      }
  double worst = 1;
  for (Index cell : shell_.all())
    worst = std::min(worst, volume_.quality_of(cell));
  for (std::size_t k = 0; k < n; ++k) {
    if (!walls->admits_apex(k))
      continue;
    if (!is_ring_better(k, better_by(swap_gain, worst)))
      continue;
    if (operator_.replace(shell_.all(), shell_.ring[k], {a, b},
                          improvement(swap_gain, run_.hausdorff.surface)))
      return true;
    if (volume_.is_put_off)
      return false;
  }
  return false;
}

} // namespace anistar
