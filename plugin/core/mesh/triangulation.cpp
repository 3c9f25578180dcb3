#include "mesh/triangulation.h"

#include "base/parallel.h"
#include "mesh/hilbert.h"

#include <numeric>

namespace anistar {

void star_of(const Triangulation<2> &mesh, Index v, std::vector<HalfFacet> &star) {
  star.clear();
  // turn clockwise to the boundary, if there is one, then counter-clockwise
  const Index start = mesh.vertex_cell[v];
  Index first = start;
  for (;;) {
    const std::size_t i = mesh.local_index(first, v);
    const HalfFacet beyond = mesh.opposite(HalfFacet(first, (i + 2) % 3));
    if (!beyond.exists() || beyond.cell() == start)
      break;
    first = beyond.cell();
  }
  if (mesh.opposite(HalfFacet(first, (mesh.local_index(first, v) + 2) % 3)).exists())
    first = start;
  Index cell = first;
  do {
    const std::size_t i = mesh.local_index(cell, v);
    star.emplace_back(cell, i);
    cell = mesh.opposite(HalfFacet(cell, (i + 1) % 3)).cell();
  } while (cell != none && cell != first);
}

namespace {

/// In place: new arrays of ever other sizes would leave holes in the memory.
template <class T>
void permute(std::vector<T> &values, const std::vector<Index> &order, int threads) {
  std::vector<T> sorted(order.size());
  parallel_ranges(order.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      sorted[k] = values[order[k]];
  });
  values.resize(order.size());
  std::copy(sorted.begin(), sorted.end(), values.begin());
}

std::vector<Index> inverse(const std::vector<Index> &order, std::size_t n) {
  std::vector<Index> rank(n, none);
  for (std::size_t k = 0; k < order.size(); ++k)
    rank[order[k]] = static_cast<Index>(k);
  return rank;
}

template <std::size_t d>
std::vector<Index> cells_by_first_vertex(const Triangulation<d> &mesh) {
  std::vector<Index> start(mesh.vertices.size() + 1, 0);
  const auto first = [&](const Cell<d> &cell) {
    return *std::min_element(cell.begin(), cell.end());
  };
  for (const Cell<d> &cell : mesh.cells)
    if (cell[0] != none)
      ++start[first(cell) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<Index> order(start.back());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    if (mesh.cells[c][0] != none)
      order[start[first(mesh.cells[c])]++] = static_cast<Index>(c);
  return order;
}

} // namespace

template <std::size_t d>
Renumbering sort_along_curve(Triangulation<d> &mesh, int threads, double shift) {
  std::vector<Index> used;
  std::vector<Vector<d>> points;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (mesh.is_used(static_cast<Index>(v))) {
      used.push_back(static_cast<Index>(v));
      points.push_back(mesh.vertices[v].x);
    }
  std::vector<Index> order = hilbert_order<d>(points, threads, shift);
  for (Index &k : order)
    k = used[k];
  std::vector<Index> rank = inverse(order, mesh.vertices.size());
  permute(mesh.vertices, order, threads);
  permute(mesh.feature, order, threads);
  permute(mesh.background_cell, order, threads);
  mesh.vertex_cell.assign(order.size(), none);
  parallel_ranges(mesh.cells.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      if (mesh.cells[c][0] != none)
        for (Index &v : mesh.cells[c])
          v = rank[v];
  });

  std::vector<Index> cell_order = cells_by_first_vertex(mesh);
  const std::vector<Index> cell_rank = inverse(cell_order, mesh.cells.size());
  permute(mesh.cells, cell_order, threads);
  permute(mesh.neighbours, cell_order, threads);
  permute(mesh.constraints, cell_order, threads);
  permute(mesh.region, cell_order, threads);
  mesh.free_cells.clear();
  parallel_ranges(mesh.cells.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      for (HalfFacet &h : mesh.neighbours[c])
        if (h.exists())
          h = HalfFacet(cell_rank[h.cell()], h.facet());
  });
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (Index v : mesh.cells[c])
      mesh.vertex_cell[v] = static_cast<Index>(c);
  return {std::move(rank), std::move(cell_order)};
}

template Renumbering sort_along_curve<2>(Triangulation<2> &, int, double);
template Renumbering sort_along_curve<3>(Triangulation<3> &, int, double);

} // namespace anistar
