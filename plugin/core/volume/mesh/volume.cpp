#include "volume/mesh/volume.h"

#include "base/parallel.h"

namespace anistar {

Index Volume::add_vertex(const Vertex<3> &vertex, Index dimension, Index lies_on,
                         Index background_cell) {
  Index v;
  if (free_vertices.empty()) {
    v = mesh.add_vertex(vertex, dimension, background_cell);
    support.push_back(lies_on);
    vertex_clock.push_back(clock);
    data->slabs.add_vertex(v);
    ridges.resize(mesh.vertices.size());
    return v;
  }
  v = free_vertices.back();
  free_vertices.pop_back();
  const auto i = static_cast<std::size_t>(v);
  mesh.vertices[i] = vertex;
  mesh.feature[i] = dimension;
  mesh.background_cell[i] = background_cell;
  support[i] = lies_on;
  vertex_clock[i] = clock;
  data->slabs.add_vertex(v);
  return v;
}

void Volume::remove_vertex(Index v) {
  mesh.vertex_cell[static_cast<std::size_t>(v)] = none;
  free_vertices.push_back(v);
}

Index Volume::add_cell() {
  if (slab) {
    const Index c = free_cells.back();
    free_cells.pop_back();
    return c;
  }
  const Index c = mesh.add_cell();
  if (static_cast<std::size_t>(c) >= quality.size()) {
    quality.push_back(0);
    walled.push_back(0);
    cell_clock.push_back(0);
  }
  if (static_cast<std::size_t>(c) >= cell_stamp_.size())
    cell_stamp_.resize(mesh.cells.size() + mesh.cells.size() / 2, 0);
  return c;
}

void Volume::free_cell(Index c) {
  if (!slab) {
    mesh.free_cell(c);
    return;
  }
  mesh.at(c)[0] = none;
  free_cells.push_back(c);
}

void Volume::measure_cell(Index c) {
  const Cell<3> &cell = mesh.at(c);
  quality[static_cast<std::size_t>(c)] =
      static_cast<float>(shape_quality(mesh.vertex(cell[0]), mesh.vertex(cell[1]),
                                       mesh.vertex(cell[2]), mesh.vertex(cell[3])));
}

void Volume::touch(Index c) {
  cell_clock[static_cast<std::size_t>(c)] = clock;
  for (Index v : mesh.at(c))
    vertex_clock[static_cast<std::size_t>(v)] = clock;
}

void star_of(Volume &volume, Index v, std::vector<Index> &cells) {
  const Triangulation<3> &mesh = volume.mesh;
  cells.clear();
  volume.open_cells();
  const Index first = mesh.vertex_cell[static_cast<std::size_t>(v)];
  volume.mark_cell(first);
  cells.push_back(first);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto c = static_cast<std::size_t>(cells[i]);
    const Cell<3> &cell = mesh.cells[c];
    const Neighbours<3> &around = mesh.neighbours[c];
    for (std::size_t k = 0; k < 4; ++k)
      if (cell[k] != v && around[k].exists() && volume.mark_cell(around[k].cell()))
        cells.push_back(around[k].cell());
  }
}

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

namespace {

template <class T>
void take_along(std::vector<T> &values, const std::vector<Index> &rank, std::size_t n) {
  std::vector<T> moved(n);
  for (std::size_t v = 0; v < rank.size(); ++v)
    if (rank[v] != none)
      moved[static_cast<std::size_t>(rank[v])] = values[v];
  values.resize(n);
  std::copy(moved.begin(), moved.end(), values.begin());
}

} // namespace

void gather_fans(Volume &volume, std::span<const Index> touching) {
  volume.fans.clear();
  for (Index v : touching)
    volume.fans[v];
  if (touching.empty())
    return;
  for (std::size_t c = 0; c < volume.mesh.cells.size(); ++c)
    if (volume.mesh.is_alive(static_cast<Index>(c)))
      for (Index v : volume.mesh.cells[c])
        if (std::vector<Index> *cells = volume.fans_of(v))
          cells->push_back(static_cast<Index>(c));
}

void renumber(Volume &volume, int threads) {
  Triangulation<3> &mesh = volume.mesh;
  const std::vector<Index> rank = sort_along_curve<3>(mesh, threads);
  const std::size_t n = mesh.vertices.size();
  take_along(volume.support, rank, n);
  take_along(volume.vertex_clock, rank, n);
  volume.ridges.renumber(rank, n);
  std::vector<Index> touching;
  for (const auto &[v, cells] : volume.fans)
    touching.push_back(rank[static_cast<std::size_t>(v)]);
  gather_fans(volume, touching);
  volume.free_vertices.clear();
  const std::size_t n_cells = mesh.cells.size();
  volume.quality.resize(n_cells);
  volume.walled.resize(n_cells);
  volume.cell_clock.resize(n_cells);
  parallel_ranges(n_cells, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      volume.measure_cell(static_cast<Index>(c));
      volume.walled[c] = 0;
      for (Index patch : mesh.constraints[c])
        volume.walled[c] |= patch != none;
      // a cell that changed has stamped its vertices: this is never too early
      std::uint32_t clock = volume.clock;
      for (Index v : mesh.cells[c])
        clock = std::min(clock, volume.vertex_clock[static_cast<std::size_t>(v)]);
      volume.cell_clock[c] = clock;
    }
  });
  volume.data->slabs = cut_into_slabs(mesh);
}

} // namespace anistar
