#pragma once
// The constrained Delaunay triangulation of points and segments.

#include "base/monitor.h"
#include "generate/plane/planar_complex.h"
#include "generate/plane/plane_mesh.h"

namespace anistar::generate {

/// The constrained Delaunay triangulation (CGAL) of the convex hull, with the segments
/// as walls. Points of no segment that are not kept are not in it.
/// @throws MeshingError when points coincide, a point lies on a segment or segments
/// cross: names the first, and counts the others.
/// @throws BudgetSpent when the monitor says so
[[nodiscard]] PlaneMesh constrained_hull(const PlanarComplex &complex,
                                         Monitor &monitor);

} // namespace anistar::generate
