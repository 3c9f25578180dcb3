#pragma once
// Walks through the two-dimensional mesh of a facet, which its walls are, and through
// the cells between walls. What a walk finds is a place to try: whether a point may be
// put there the exact predicates of its cavity decide.

#include "generate/refinement/mesh/plc_faces.h"
#include "generate/refinement/mesh/walled_mesh.h"

namespace anistar::generate {

/// Where a walk in a facet has come to.
struct FacetWalk {
  HalfFacet wall; ///< that holds the target, or the last one before the border
  Segment border{none, none}; ///< the subsegment in the way, if there is one
  bool is_lost = false;       ///< flat walls, or no end

  [[nodiscard]] bool has_arrived() const { return !is_lost && border[0] == none; }
};

/// Walks from a wall straight to x, on the facet of that wall, seen along the
/// coordinate that its projection leaves out.
[[nodiscard]] FacetWalk walk_in_facet(const WalledMesh &mesh, const PlcFaces &faces,
                                      HalfFacet start, const Vector<3> &x);

/// x moved along that coordinate onto the plane of a wall.
[[nodiscard]] Vector<3> put_on_wall(const WalledMesh &mesh, const PlcFaces &faces,
                                    HalfFacet wall, const Vector<3> &x);

/// Where a walk in space has come to.
struct SpaceWalk {
  Index cell = none; ///< that holds the target
  HalfFacet wall;    ///< the first one in the way, if there is one
};

/// Walks from the middle of a cell straight to x.
[[nodiscard]] SpaceWalk walk_in_space(const WalledMesh &mesh, Index start,
                                      const Vector<3> &x);

} // namespace anistar::generate
