#pragma once
// The smooth surfaces of a 3D geometry beside its facets.

#include "mesh/facet_shapes.h"
#include "surface/surface_input.h"

namespace anistar {

[[nodiscard]] FacetShapes facet_shapes(const SurfaceInput &input);

} // namespace anistar
