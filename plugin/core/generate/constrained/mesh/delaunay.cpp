#include "generate/constrained/mesh/delaunay.h"

#include "base/errors.h"
#include "mesh/hilbert.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

namespace anistar::generate {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<Index, Kernel>;
using CellBase = CGAL::Triangulation_cell_base_with_info_3<
    Index, Kernel, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Delaunay = CGAL::Delaunay_triangulation_3<
    Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

/// A round for each point, twice as many in each as in the one before, without pattern
/// (splitmix64): Amenta, Choi, Rote, Incremental constructions con BRIO, 2003.
int round_of(Index v) {
  std::uint64_t bits = (static_cast<std::uint64_t>(v) + 1) * 0x9e3779b97f4a7c15u;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return -std::countr_zero(bits ^ (bits >> 31));
}

/// Rounds, each along a Hilbert curve.
std::vector<Index> insertion_order(const ExactPoints &points,
                                   std::span<const Index> vertices) {
  std::vector<Vector<3>> places;
  places.reserve(vertices.size());
  for (const Index v : vertices)
    places.push_back(points.rounded(v));
  std::vector<Index> order = hilbert_order<3>(places);
  for (Index &item : order)
    item = vertices[item];
  std::ranges::stable_sort(order, {}, round_of);
  return order;
}

[[noreturn]] void refuse_duplicate(const ExactPoints &points, Index one, Index other) {
  throw MeshingError("points " + std::to_string(std::min(one, other)) + " and " +
                         std::to_string(std::max(one, other)) + " are the same",
                     points.rounded(one));
}

Delaunay inserted(const ExactPoints &points, std::span<const Index> vertices) {
  Delaunay mesh;
  Delaunay::Cell_handle near;
  for (const Index v : insertion_order(points, vertices)) {
    const Vector<3> &x = points.rounded(v);
    const auto before = mesh.number_of_vertices();
    const Delaunay::Vertex_handle vertex =
        mesh.insert(Kernel::Point_3(x[0], x[1], x[2]), near);
    if (mesh.number_of_vertices() == before)
      refuse_duplicate(points, vertex->info(), v);
    vertex->info() = v;
    near = vertex->cell();
  }
  if (mesh.dimension() < 3)
    throw MeshingError("all points lie on one plane",
                       vertices.empty() ? Vector<3>(Vector<3>::Zero())
                                        : points.rounded(vertices[0]));
  mesh.infinite_vertex()->info() = ghost;
  return mesh;
}

/// The same orientation, with the two least vertices first.
Cell<3> canonical(Cell<3> cell) {
  const auto least = std::ranges::min_element(cell) - cell.begin();
  // even permutations that bring each place to the front
  constexpr std::size_t front[4][4] = {
      {0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
  Cell<3> turned;
  for (std::size_t i = 0; i < 4; ++i)
    turned[i] = cell[front[least][i]];
  const auto second = std::min_element(turned.begin() + 1, turned.end());
  std::rotate(turned.begin() + 1, second, turned.end());
  return turned;
}

} // namespace

GhostMesh delaunay(const ExactPoints &points, std::span<const Index> vertices) {
  const Delaunay mesh = inserted(points, vertices);
  std::vector<std::pair<Cell<3>, Delaunay::Cell_handle>> cells;
  cells.reserve(mesh.tds().number_of_cells());
  for (auto c = mesh.all_cells_begin(); c != mesh.all_cells_end(); ++c) {
    Cell<3> cell;
    for (std::size_t i = 0; i < 4; ++i)
      cell[i] = c->vertex(static_cast<int>(i))->info();
    cells.emplace_back(canonical(cell), c);
  }
  std::ranges::sort(cells, {}, [](const auto &entry) { return entry.first; });

  GhostMesh out(points.size());
  for (const auto &[cell, handle] : cells)
    handle->info() = out.add(cell);
  const auto half_facet = [&](Delaunay::Cell_handle c, int i) {
    return HalfFacet(c->info(), *out.index_of(c->info(), c->vertex(i)->info()));
  };
  for (const auto &[cell, handle] : cells)
    for (int i = 0; i < 4; ++i)
      out.join(half_facet(handle, i),
               half_facet(handle->neighbor(i), mesh.mirror_index(handle, i)));
  return out;
}

} // namespace anistar::generate
