#pragma once
// The walls of a mesh as a list, each once.

#include "generate/plane/plane_mesh.h"
#include "generate/plc.h"

namespace anistar::generate {

struct WallList {
  std::vector<Segment> edges;  ///< the domain is on the left of what bounds it
  std::vector<Index> segments; ///< that each is a part of
};

[[nodiscard]] WallList walls_of(const PlaneMesh &mesh);

/// Triangles with their neighbours and walls.
/// @throws std::invalid_argument when three triangles share an edge
[[nodiscard]] PlaneMesh walled_mesh(std::span<const Vector<2>> points,
                                    std::span<const Cell<2>> cells,
                                    std::span<const Index> regions,
                                    std::span<const Segment> walls,
                                    std::span<const Index> segments);

} // namespace anistar::generate
