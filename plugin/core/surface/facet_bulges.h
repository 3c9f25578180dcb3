#pragma once
// How the smooth surfaces of a mesh bulge over its facets.

#include "certificate/surface/facet_bulge.h"
#include "surface/surface_input.h"

#include <vector>

namespace anistar {

/// Planar patches do not bulge; on the others the normals are those of jets.
[[nodiscard]] std::vector<FacetBulge<3>> facet_bulges(const SurfaceInput &input);

} // namespace anistar
