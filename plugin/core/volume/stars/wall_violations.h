#pragma once
// Which walls of a volume mesh are not in the surface stars of their vertices.

#include "certificate/surface/surface_stars.h"
#include "volume/stars/facet_margins.h"

namespace anistar {

/// The walls of a mesh as the surface stars of their vertices see them, each once.
[[nodiscard]] std::vector<SeenFacet<3>> seen_walls(const Volume &volume,
                                                   const SurfaceNormals &normals);

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
