#pragma once
// The curves of a 2D geometry beside its facets.

#include "mesh/facet_shapes.h"
#include "plane/geometry/curves.h"

namespace anistar {

[[nodiscard]] FacetShapes facet_shapes(const GeometryInput &input);

} // namespace anistar
