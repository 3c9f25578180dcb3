#pragma once
// From a triangle straight to a place.

#include "generate/plane/plane_mesh.h"

namespace anistar::generate {

/// Where a walk has ended.
struct Place {
  enum class Kind { in_cell, on_edge, on_vertex, beyond };
  Kind kind;
  HalfFacet at; ///< the edge, or the one that is opposite the vertex, or that hides it
};

enum class Walls { stop, let_pass };

/// Walks from the inside of a triangle straight to p, up to a boundary, and to a wall
/// if walls stop it. Exact, so that it cannot go round in circles.
[[nodiscard]] Place walk_to(const PlaneMesh &mesh, Index cell, const Vector<2> &p,
                            Walls walls);

} // namespace anistar::generate
