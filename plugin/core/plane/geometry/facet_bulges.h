#pragma once
// How the smooth curves of a 2D mesh bulge over its facets.

#include "certificate/surface/facet_bulge.h"
#include "plane/geometry/curves.h"

#include <vector>

namespace anistar {

/// Straight facets do not bulge; on the others the normals are those of the curves.
[[nodiscard]] std::vector<FacetBulge<2>> facet_bulges(const GeometryInput &input);

} // namespace anistar
