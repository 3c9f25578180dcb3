#pragma once
// Walks through a mesh that is being changed: straight on, and not across its facets.

#include "mesh/blocks.h"

namespace anistar {

/// What a walk through the mesh met.
struct Walk {
  Index cell = none; ///< where the point is, none when it was stopped
  HalfFacet wall;    ///< by this constrained facet, if it exists
};

/// Walks from a cell towards x without crossing a constraint or leaving the range.
template <std::size_t d>
[[nodiscard]] Walk walk_to(const Triangulation<d> &mesh, Index start,
                           const Vector<d> &x, const VertexRange &range = {});

} // namespace anistar
