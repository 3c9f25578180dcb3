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
    at_rest.push_back(0);
    state.slabs.add_vertex(v);
    ridges.resize(mesh.vertices.size());
    return v;
  }
  v = free_vertices.back();
  free_vertices.pop_back();
  mesh.vertices[v] = vertex;
  mesh.feature[v] = dimension;
  mesh.background_cell[v] = background_cell;
  support[v] = lies_on;
  vertex_clock[v] = clock;
  at_rest[v] = 0;
  state.slabs.add_vertex(v);
  return v;
}

void Volume::remove_vertex(Index v) {
  mesh.vertex_cell[v] = none;
  (slab ? removed : free_vertices).push_back(v);
}

Index Volume::add_cell() {
  if (slab) {
    const Index c = free_cells.back();
    free_cells.pop_back();
    return c;
  }
  const Index c = mesh.add_cell();
  if (std::cmp_greater_equal(c, quality.size())) {
    quality.push_back(0);
    walled.push_back(0);
    cell_clock.push_back(0);
  }
  if (std::cmp_greater_equal(c, cell_stamp_.size()))
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
  quality[c] =
      static_cast<float>(shape_quality(mesh.vertex(cell[0]), mesh.vertex(cell[1]),
                                       mesh.vertex(cell[2]), mesh.vertex(cell[3])));
}

void Volume::touch(Index c) {
  cell_clock[c] = clock;
  for (Index v : mesh.at(c))
    vertex_clock[v] = clock;
}

void star_of(Volume &volume, Index v, std::vector<Index> &cells) {
  const Triangulation<3> &mesh = volume.mesh;
  cells.clear();
  volume.open_cells();
  const Index first = mesh.vertex_cell[v];
  volume.mark_cell(first);
  cells.push_back(first);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Index c = cells[i];
    const Cell<3> &cell = mesh.cells[c];
    const Neighbours<3> &around = mesh.neighbours[c];
    for (std::size_t k = 0; k < 4; ++k)
      if (cell[k] != v && around[k].exists() && volume.mark_cell(around[k].cell()))
        cells.push_back(around[k].cell());
  }
}

namespace {

template <class T>
void take_along(std::vector<T> &values, const std::vector<Index> &rank, std::size_t n) {
  std::vector<T> moved(n);
  for (std::size_t v = 0; v < rank.size(); ++v)
    if (rank[v] != none)
      moved[rank[v]] = values[v];
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

PerCell<Index> renumber(Volume &volume, int threads) {
  Triangulation<3> &mesh = volume.mesh;
  auto [rank, old_cell] = sort_along_curve<3>(mesh, threads);
  const std::size_t n = mesh.vertices.size();
  take_along(volume.support, rank, n);
  take_along(volume.vertex_clock, rank, n);
  take_along(volume.at_rest, rank, n);
  volume.ridges.renumber(rank, n);
  std::vector<Index> touching;
  for (const auto &[v, cells] : volume.fans)
    touching.push_back(rank[v]);
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
        clock = std::min(clock, volume.vertex_clock[v]);
      volume.cell_clock[c] = clock;
    }
  });
  volume.state.slabs = cut_into_slabs(mesh);
  return std::move(old_cell);
}

} // namespace anistar
