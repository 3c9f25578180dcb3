#pragma once
// The arrays of a geometry as the two meshers take them.

#include "bindings/support/mesh_arrays.h"
#include "plane/geometry/curves.h"
#include "surface/surface_input.h"

namespace anistar::bindings {

/// @pre cell tags are ranks, which are no region but one of the domain
[[nodiscard]] inline GeometryInput curves_of(const MeshArrays &mesh,
                                             const DomainShape &shape) {
  return {points_of<2>(mesh.points),
          cells_of<2>(mesh.cells),
          indices_of(mesh.cell_tags),
          facets_of<2>(mesh.facets),
          indices_of(mesh.facet_tags),
          indices_of(mesh.corners),
          shape};
}

[[nodiscard]] inline SurfaceInput surfaces_of(const MeshArrays &mesh,
                                              const DomainShape &shape) {
  return {points_of<3>(mesh.points),
          facets_of<3>(mesh.facets),
          indices_of(mesh.facet_tags),
          pairs_of(mesh.edges),
          indices_of(mesh.edge_tags),
          indices_of(mesh.corners),
          shape};
}

} // namespace anistar::bindings
