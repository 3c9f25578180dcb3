#pragma once
// What is inside, as a mesh without ghost.

#include "generate/constrained/exact_points.h"
#include "generate/constrained/facet_triangles.h"
#include "generate/constrained/ghost_mesh.h"

namespace anistar::generate {

/// Cells with a region, walls and edges of segments that they have.
[[nodiscard]] Tetrahedralisation output(const ExactPoints &points,
                                        const GhostMesh &mesh,
                                        const FacetTriangles &facets,
                                        const PerCell<Index> &regions);

} // namespace anistar::generate
