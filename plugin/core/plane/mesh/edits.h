#pragma once
// The edits of a mesh on its curves, each one cavity of the cavity operator.

#include "plane/mesh/workspace.h"

namespace anistar {

/// Whether the edge is constrained and p lies inside its diametral ellipse, in the
/// metric of p.
[[nodiscard]] bool encroaches(const Triangulation<2> &mesh, const Vertex<2> &p,
                              HalfFacet edge);

/// Inserts an interior vertex into the cell that contains it. @returns the vertex, none
/// when it lies too near to an edge. The new cells are cavity.star().
[[nodiscard]] Index insert_in_cell(Triangulation<2> &mesh, Cavity &cavity, Index cell,
                                   const Vertex<2> &vertex, Index background_cell);

/// Splits an edge in its middle: on the curve if it is constrained. @returns the new
/// vertex, none when the edge is frozen or protected, or the curve cannot be followed
/// validly.
[[nodiscard]] Index split_edge(Workspace &w, HalfFacet edge);

/// The removal of a vertex into its neighbour, and what that means for its curve.
struct Collapse {
  Index vertex, target;
  std::vector<HalfFacet> star;         ///< scratch
  std::vector<HalfFacet> skipped;      ///< boundary edges that vanish
  std::vector<SpokeConstraint> spokes; ///< the merged curve edge
  CurveEdge merged{};                  ///< valid when spokes is not empty
  std::array<Index, 2> halves{};       ///< the curve edges that merge
};

/// Bounds w.cavity for collapse.vertex and collapse.target, and fills in the rest.
/// @returns false when that is not valid: the vertex is a corner or leaves its curve, a
/// cell would be inverted, or the boundary would run into another part of it.
[[nodiscard]] bool bound_collapse(Workspace &w, Collapse &collapse);
/// Carries the collapse out. @pre bound_collapse was true and nothing changed since.
void fill_collapse(Workspace &w, Collapse &collapse);

} // namespace anistar
