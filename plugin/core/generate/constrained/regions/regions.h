#pragma once
// Which cells are inside, and in which region.

#include "generate/constrained/facets/facet_triangles.h"
#include "generate/constrained/mesh/ghost_mesh.h"
#include "generate/constrained/points/exact_points.h"
#include "generate/constrained/regions/region_rule.h"

namespace anistar::generate {

/// The region of a cell outside.
inline constexpr Index outside = none;

/// The region of each cell: the tag of a seed, a winding number, or else a number from
/// one on that is no tag, by the connected component.
/// @throws MeshingError if nothing is inside, a seed lies outside or on a facet, or two
/// seeds with different tags lie in one region
[[nodiscard]] PerCell<Index> regions_of(const ExactPoints &points,
                                        const GhostMesh &mesh,
                                        const FacetTriangles &facets,
                                        const RegionChoice &choice);

} // namespace anistar::generate
