#pragma once
// What is inside, as a mesh without ghost.

#include "generate/constrained/facets/facet_triangles.h"
#include "generate/constrained/mesh/ghost_mesh.h"
#include "generate/constrained/points/exact_points.h"

namespace anistar::generate {

/// Cells with a region, walls and edges of segments that they have.
[[nodiscard]] Tetrahedralisation output(const ExactPoints &points,
                                        const GhostMesh &mesh,
                                        const FacetTriangles &facets,
                                        const PerCell<Index> &regions);

} // namespace anistar::generate
