#pragma once
// The edges of curves as the surface stars of their ends see them.

#include "certificate/surface/surface_stars.h"
#include "plane/mesh/workspace.h"

namespace anistar {

/// Each once, but for those in protecting balls, which nothing splits. The curves may
/// ask a projection of the user.
[[nodiscard]] std::vector<SeenFacet<2>> seen_curves(const Workspace &w);

} // namespace anistar
