#pragma once
// Triangles with walls, and the operations that keep them constrained Delaunay.

#include "base/predicates.h"
#include "mesh/adjacency.h"

#include <span>
#include <vector>

namespace anistar::generate {

/// Positively oriented triangles, at every instant.
struct PlaneMesh {
  PerVertex<Vector<2>> points;
  PerCell<Cell<2>> cells;
  PerCell<Neighbours<2>> neighbours;
  PerCell<std::array<Index, 3>> walls; ///< the segment that an edge is part of, or none
  PerCell<Index> regions;

  [[nodiscard]] Index wall(HalfFacet h) const { return walls[h.cell()][h.facet()]; }
  [[nodiscard]] HalfFacet opposite(HalfFacet h) const {
    return neighbours[h.cell()][h.facet()];
  }
  [[nodiscard]] Facet<2> edge(HalfFacet h) const {
    return facet_of<2>(cells[h.cell()], h.facet());
  }
  [[nodiscard]] Index apex(HalfFacet h) const { return cells[h.cell()][h.facet()]; }
  [[nodiscard]] Simplex<2> simplex(Index c) const {
    const Cell<2> &cell = cells[c];
    return {points[cell[0]], points[cell[1]], points[cell[2]]};
  }
  [[nodiscard]] std::size_t local_index(Index c, Index v) const {
    const Cell<2> &cell = cells[c];
    return cell[0] == v ? 0 : cell[1] == v ? 1 : 2;
  }
};

/// Whether p is inside of the circle through a triangle.
[[nodiscard]] bool is_in_circle(const PlaneMesh &mesh, Index cell, const Vector<2> &p);

/// Whether an edge may be there: it is a wall, or no vertex next to it is inside of the
/// circle of the triangle on the other side.
[[nodiscard]] bool is_locally_delaunay(const PlaneMesh &mesh, HalfFacet h);

/// Inserts the last vertex into a triangle, and flips edges until they are Delaunay.
/// @pre it is strictly inside.
/// @returns a triangle at it
Index insert_in_cell(PlaneMesh &mesh, Index cell);

/// The same on an edge, which may be a wall: both parts are.
/// @pre has_room_on_edge
Index insert_on_edge(PlaneMesh &mesh, HalfFacet h);

/// Whether the triangles that a vertex at p on an edge makes are positively oriented,
/// which rounding decides where they are narrow.
[[nodiscard]] bool has_room_on_edge(const PlaneMesh &mesh, HalfFacet h,
                                    const Vector<2> &p);

/// Calls with every triangle at v, each as the edge opposite v; counter-clockwise from
/// the given one up to a boundary, then clockwise.
template <class Visit>
void for_star(const PlaneMesh &mesh, Index v, Index cell, const Visit &visit) {
  const HalfFacet first(cell, mesh.local_index(cell, v));
  for (const std::size_t side : {1u, 2u}) {
    HalfFacet h = first;
    do {
      if (side == 1 || h != first)
        visit(h);
      const HalfFacet next = mesh.opposite(HalfFacet(h.cell(), (h.facet() + side) % 3));
      if (!next.exists())
        break;
      h = HalfFacet(next.cell(), mesh.local_index(next.cell(), v));
      if (h == first)
        return;
    } while (true);
  }
}

} // namespace anistar::generate
