#include "volume/mesh/shell.h"

namespace anistar {
namespace {

/// The positions p, q of the two vertices of a cell that are not at i and j, such that
/// (i, j, p, q) is an even permutation.
constexpr std::array<std::size_t, 2> other_two(std::size_t i, std::size_t j) {
  constexpr std::size_t table[4][4][2] = {{{0, 0}, {2, 3}, {3, 1}, {1, 2}},
                                          {{3, 2}, {0, 0}, {0, 3}, {2, 0}},
                                          {{1, 3}, {3, 0}, {0, 0}, {0, 1}},
                                          {{2, 1}, {0, 2}, {1, 0}, {0, 0}}};
  return {table[i][j][0], table[i][j][1]};
}

} // namespace

bool shell_of(const Triangulation<3> &mesh, Index start, Index a, Index b,
              Shell &shell) {
  shell.a = a;
  shell.b = b;
  const auto [p, q] = other_two(mesh.local_index(start, a), mesh.local_index(start, b));
  shell.cells[0] = start;
  shell.ring[0] = mesh.at(start)[p];
  shell.ring[1] = mesh.at(start)[q];
  shell.n_cells = 1;
  std::size_t leave = p;
  for (;;) { // forwards, through the facet with the newest vertex of the ring
    const HalfFacet beyond =
        mesh.opposite(HalfFacet(shell.cells[shell.n_cells - 1], leave));
    if (!beyond.exists())
      break;
    if (beyond.cell() == start) {
      shell.is_closed = true;
      return true;
    }
    if (shell.n_cells == Shell::capacity)
      return false;
    shell.cells[shell.n_cells] = beyond.cell();
    leave = mesh.local_index(beyond.cell(), shell.ring[shell.n_cells]);
    shell.ring[++shell.n_cells] = mesh.at(beyond.cell())[beyond.facet()];
    // the facet to leave by is opposite the older of the two ring vertices
  }
  shell.is_closed = false;
  std::size_t back = 0;
  std::array<Index, Shell::capacity> cells, ring;
  Index current = start, newest = shell.ring[0];
  leave = q;
  for (;;) {
    const HalfFacet beyond = mesh.opposite(HalfFacet(current, leave));
    if (!beyond.exists())
      break;
    if (shell.n_cells + back == Shell::capacity)
      return false;
    current = beyond.cell();
    leave = mesh.local_index(current, newest);
    newest = mesh.at(current)[beyond.facet()];
    cells[back] = current;
    ring[back++] = newest;
  }
  if (back > 0) {
    for (std::size_t k = shell.n_cells + 1; k-- > 0;)
      shell.ring[k + back] = shell.ring[k];
    for (std::size_t k = shell.n_cells; k-- > 0;)
      shell.cells[k + back] = shell.cells[k];
    for (std::size_t k = 0; k < back; ++k) {
      shell.cells[back - 1 - k] = cells[k];
      shell.ring[back - 1 - k] = ring[k];
    }
    shell.n_cells += back;
  }
  return true;
}

EdgeWalls walls_at(const Volume &volume, const Shell &shell) {
  EdgeWalls walls;
  const Triangulation<3> &mesh = volume.mesh;
  const auto note = [&](std::size_t position, Index patch) {
    if (patch == none)
      return;
    if (walls.n < walls.patch.size()) {
      walls.position[walls.n] = position;
      walls.patch[walls.n] = patch;
    }
    ++walls.n;
  };
  for (std::size_t k = 0; k < shell.n_cells; ++k) {
    const Index c = shell.cells[k];
    if (!volume.is_walled(c))
      continue;
    // the facet (a, b, ring[k]) of cell k is opposite ring[k + 1]
    const std::size_t next = k + 1 == shell.n_ring() ? 0 : k + 1;
    note(k, mesh.constraint(HalfFacet(c, mesh.local_index(c, shell.ring[next]))));
    if (!shell.is_closed && k + 1 == shell.n_cells)
      note(k + 1, mesh.constraint(HalfFacet(c, mesh.local_index(c, shell.ring[k]))));
  }
  return walls;
}

std::optional<EdgeWalls> walls_of_removable(const Volume &volume, Index cell, Index a,
                                            Index b, std::size_t longest_ring,
                                            Shell &shell) {
  if (!shell_of(volume.mesh, cell, a, b, shell) || shell.n_ring() < 3 ||
      shell.n_ring() > longest_ring)
    return {};
  const EdgeWalls walls = walls_at(volume, shell);
  const bool is_ridge = volume.feature(a) <= 1 && volume.feature(b) <= 1 &&
                        volume.ridges.find(a, b) != none;
  if (is_ridge || !(walls.n == 0 || (walls.n == 2 && walls.patch[0] == walls.patch[1])))
    return {};
  return walls;
}

EdgeFeature feature_of(const Volume &volume, const Shell &shell) {
  EdgeFeature out;
  const EdgeWalls walls = walls_at(volume, shell);
  for (std::size_t k = 0; k < std::min(walls.n, walls.patch.size()); ++k)
    out.is_frozen = out.is_frozen || volume.surface.patch(walls.patch[k]).is_frozen;
  if (volume.feature(shell.a) <= 1 && volume.feature(shell.b) <= 1)
    out.ridge = volume.ridges.find(shell.a, shell.b);
  if (out.ridge != none) {
    out.dimension = 1;
    out.lies_on = volume.ridges.at(out.ridge).curve;
    out.is_frozen = out.is_frozen || volume.surface.curve(out.lies_on).is_frozen;
  } else if (walls.n > 0) {
    out.dimension = 2;
    out.lies_on = walls.patch[0];
  }
  return out;
}

} // namespace anistar
