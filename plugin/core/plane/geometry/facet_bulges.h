#pragma once
// How the smooth curves of a 2D mesh bulge over its facets.

#include "certificate/surface/facet_bulge.h"
#include "plane/geometry/curves.h"

#include <vector>

namespace anistar {

/// How high a curve is over the middle of its chord over [t0, t1], on the left; zero
/// where it is straight but for round-off.
[[nodiscard]] double chord_height(const Curve &curve, double t0, double t1);

/// Straight facets do not bulge; on the others the normals are those of the curves.
[[nodiscard]] std::vector<FacetBulge<2>> facet_bulges(const GeometryInput &input);

} // namespace anistar
