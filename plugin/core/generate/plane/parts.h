#pragma once
// The parts of the plane between closed loops of segments, and which are meshed.

#include "base/monitor.h"
#include "generate/plane/planar_complex.h"
#include "generate/plane/plane_mesh.h"

namespace anistar::generate {

/// Keeps of a triangulated hull what is inside: the part around a seed with its tag,
/// not that around a hole, and of the others what complex.inside says, with tag 0 or
/// the winding number. Segments that end in a part do not divide it.
/// @throws MeshingError when a seed or a hole is outside, on a segment, or contradicts
/// another; when segments should wind around but those at a point do not go on; when
/// nothing is inside.
[[nodiscard]] PlaneMesh inside_of(const PlaneMesh &hull, const PlanarComplex &complex,
                                  Monitor &monitor);

} // namespace anistar::generate
