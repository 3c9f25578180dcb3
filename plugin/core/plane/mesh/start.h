#pragma once
// From curves to a first valid triangulation of the domain.

#include "base/errors.h"
#include "mesh/triangulation.h"
#include "plane/geometry/outline.h"

namespace anistar {

/// A mesh on its curves: what every phase of the 2D mesher works on.
struct MeshOnCurves {
  Triangulation<2> mesh;
  std::vector<CurveEdge> curve_edges; ///< the constraints of `mesh` are indices here
};

/// The constrained Delaunay triangulation (CGAL) of the outline, without what lies
/// outside; regions come from the sides of the curves.
/// The outline retreats to the polyline of the geometry where its chords cross or leave
/// a region on the wrong side, so that a valid geometry always has a start.
/// @param look is called now and then; what it throws comes through
/// @throws MeshingError when the geometry itself crosses.
[[nodiscard]] MeshOnCurves triangulate(Geometry &geometry,
                                       const Background<2> &background, Outline outline,
                                       const std::function<void()> &look);

} // namespace anistar
