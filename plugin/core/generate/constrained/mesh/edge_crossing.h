#pragma once
// What lies on the way from one vertex of a tetrahedralisation to another.

#include "generate/constrained/mesh/ghost_mesh.h"
#include "generate/constrained/points/exact_points.h"

#include <vector>

namespace anistar::generate {

/// The vertices of the cells on a walk from one vertex straight to another that is no
/// neighbour of it, without the two; sorted.
[[nodiscard]] std::vector<Index> vertices_between(const ExactPoints &points,
                                                  const GhostMesh &mesh, Index from,
                                                  Index to);

} // namespace anistar::generate
