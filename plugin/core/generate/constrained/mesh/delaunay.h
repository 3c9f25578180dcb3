#pragma once
// The Delaunay tetrahedralisation of given points.

#include "generate/constrained/mesh/ghost_mesh.h"
#include "generate/constrained/points/exact_points.h"

namespace anistar::generate {

/// The Delaunay tetrahedralisation of some of the points, unique under the perturbation
/// of ExactPoints::is_in_sphere; cells are numbered in the order of their vertices.
/// @throws MeshingError if two points agree, or all lie on a plane
[[nodiscard]] GhostMesh delaunay(const ExactPoints &points,
                                 std::span<const Index> vertices);

} // namespace anistar::generate
