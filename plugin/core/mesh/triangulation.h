#pragma once
// One conforming simplicial mesh that is valid at every instant.

#include "mesh/adjacency.h"
#include "mesh/measures.h"

#include <span>
#include <vector>

namespace anistar {

/// Places for new vertices and cells that a mesh keeps for one thread: its arrays must
/// not grow while others read them.
struct Slots {
  Index vertex = 0, last_vertex = 0, cell = 0, last_cell = 0;

  /// For one vertex in the inside: it makes two more cells.
  [[nodiscard]] bool has_room() const {
    return vertex < last_vertex && cell + 2 <= last_cell;
  }
};

/// Cells, their neighbours, the constraints on their facets and their region tags. A
/// facet with a constraint is part of the boundary or of an interface; the constraint
/// is an index into a table that the geometry keeps.
template <std::size_t d> struct Triangulation {
  static constexpr Index corner = 0;   ///< feature dimension of a vertex that must stay
  static constexpr Index interior = d; ///< and of a vertex that is free

  PerVertex<Vertex<d>> vertices;
  PerVertex<Index> feature;         ///< dimension of the feature a vertex lies on
  PerVertex<Index> vertex_cell;     ///< one cell of its star, none when removed
  PerVertex<Index> background_cell; ///< where its metric was found

  PerCell<Cell<d>> cells; ///< cells[c][0] == none when c is free
  PerCell<Neighbours<d>> neighbours;
  PerCell<std::array<Index, d + 1>> constraints;
  PerCell<Index> region;
  std::vector<Index> free_cells;

  [[nodiscard]] Index add_vertex(const Vertex<d> &vertex, Index feature_dimension,
                                 Index background, Slots *slots = nullptr) {
    if (slots) {
      const std::size_t v = slots->vertex;
      vertices[v] = vertex;
      feature[v] = feature_dimension;
      background_cell[v] = background;
      return slots->vertex++;
    }
    vertices.push_back(vertex);
    feature.push_back(feature_dimension);
    vertex_cell.push_back(none);
    background_cell.push_back(background);
    return static_cast<Index>(vertices.size()) - 1;
  }
  [[nodiscard]] Index add_cell(Slots *slots = nullptr) {
    if (slots)
      return slots->cell++;
    if (!free_cells.empty()) {
      const Index cell = free_cells.back();
      free_cells.pop_back();
      return cell;
    }
    cells.emplace_back();
    neighbours.emplace_back();
    constraints.emplace_back();
    region.push_back(none);
    return static_cast<Index>(cells.size()) - 1;
  }
  /// Room for so many new vertices in the inside. What is not used counts as removed,
  /// and sort_along_curve drops it.
  [[nodiscard]] Slots make_slots(std::size_t n_new) {
    const auto n = static_cast<Index>(vertices.size() + n_new);
    const auto m = static_cast<Index>(cells.size() + 2 * n_new);
    const Slots slots{static_cast<Index>(vertices.size()), n,
                      static_cast<Index>(cells.size()), m};
    vertices.resize(n);
    feature.resize(n, interior);
    vertex_cell.resize(n, none);
    background_cell.resize(n, none);
    Cell<d> free;
    free.fill(none);
    cells.resize(m, free);
    neighbours.resize(m);
    constraints.resize(m, free);
    region.resize(m, none);
    return slots;
  }
  void free_cell(Index c) {
    at(c)[0] = none;
    free_cells.push_back(c);
  }

  [[nodiscard]] Cell<d> &at(Index c) { return cells[c]; }
  [[nodiscard]] const Cell<d> &at(Index c) const { return cells[c]; }
  [[nodiscard]] Vertex<d> &vertex(Index v) { return vertices[v]; }
  [[nodiscard]] const Vertex<d> &vertex(Index v) const { return vertices[v]; }
  [[nodiscard]] bool is_alive(Index c) const { return at(c)[0] != none; }
  [[nodiscard]] bool is_used(Index v) const { return vertex_cell[v] != none; }
  [[nodiscard]] HalfFacet opposite(HalfFacet h) const {
    return neighbours[h.cell()][h.facet()];
  }
  [[nodiscard]] Index constraint(HalfFacet h) const {
    return constraints[h.cell()][h.facet()];
  }
  [[nodiscard]] Facet<d> facet(HalfFacet h) const {
    return facet_of<d>(at(h.cell()), h.facet());
  }
  /// The vertex of the cell of h that is not on h.
  [[nodiscard]] Index apex(HalfFacet h) const { return at(h.cell())[h.facet()]; }

  void set_constraint(HalfFacet h, Index value) {
    constraints[h.cell()][h.facet()] = value;
  }
  void join(HalfFacet h, HalfFacet other) {
    neighbours[h.cell()][h.facet()] = other;
    if (other.exists())
      neighbours[other.cell()][other.facet()] = h;
  }
  [[nodiscard]] std::size_t local_index(Index c, Index v) const {
    const Cell<d> &cell = at(c);
    std::size_t i = 0;
    while (i < d && cell[i] != v)
      ++i;
    return i;
  }
  [[nodiscard]] Simplex<d> simplex(Index c) const {
    Simplex<d> s;
    for (std::size_t i = 0; i <= d; ++i)
      s[i] = vertex(at(c)[i]).x;
    return s;
  }
  [[nodiscard]] std::size_t n_cells() const { return cells.size() - free_cells.size(); }
};

/// The star of v: its cells, each as the half-facet opposite v. In 2D in
/// counter-clockwise order, from the boundary on if v is a boundary vertex.
void star_of(const Triangulation<2> &mesh, Index v, std::vector<HalfFacet> &star);

/// Where vertices and cells have gone.
struct Renumbering {
  PerVertex<Index> rank;   ///< of every old vertex, `none` if it was dropped
  PerCell<Index> old_cell; ///< of every new cell
};

/// Renumbers vertices along a Hilbert curve and cells by their first vertex; drops what
/// is no longer used. The vertices of a cell stay in their order.
/// @param shift see hilbert_order
template <std::size_t d>
Renumbering sort_along_curve(Triangulation<d> &mesh, int threads = 1, double shift = 0);

} // namespace anistar
