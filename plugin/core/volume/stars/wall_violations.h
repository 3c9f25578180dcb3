#pragma once
// Which walls of a volume mesh are not in the surface stars of their vertices.

#include "certificate/certificate.h"
#include "volume/stars/facet_margins.h"

namespace anistar {

/// A wall, and a vertex inside of a surface ball of it that it can reach (see
/// certificate/surface/surface_stars.h).
struct WallViolation {
  HalfFacet wall;
  Index inside;
};

/// One for each of these walls.
[[nodiscard]] std::vector<WallViolation> wall_violations(const Volume &volume,
                                                         const SurfaceNormals &normals,
                                                         int threads, const Look &look);

} // namespace anistar
