#pragma once
// What the steps of a constrained Delaunay tetrahedralisation work on.

#include "generate/constrained/exact_points.h"
#include "generate/constrained/facet_triangles.h"
#include "generate/constrained/ghost_mesh.h"

namespace anistar::generate {

struct Complex {
  ExactPoints points;
  GhostMesh mesh;
  FacetTriangles facets;
};

} // namespace anistar::generate
