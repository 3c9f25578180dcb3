#pragma once
// What the steps of a constrained Delaunay tetrahedralisation work on.

#include "generate/constrained/facets/facet_triangles.h"
#include "generate/constrained/mesh/ghost_mesh.h"
#include "generate/constrained/points/exact_points.h"

namespace anistar::generate {

struct Complex {
  ExactPoints points;
  GhostMesh mesh;
  FacetTriangles facets;
};

} // namespace anistar::generate
