#pragma once
// Polygon facets cut into triangles.

#include "generate/facets/facet_loops.h"
#include "generate/plc.h"

#include <vector>

namespace anistar::generate {

struct TriangulatedFacets {
  std::vector<Facet<3>> triangles; ///< turned as the outer loop of their facet
  std::vector<Index> triangle_facets;
  std::vector<double> deviations; ///< of each facet: the farthest point from its plane
};

/// The constrained Delaunay triangulation of each facet as it looks along an axis; what
/// an odd number of its loops enclose is filled.
///
/// @param edges Those between points of a facet are edges of its triangles, unless they
/// cross its loops.
/// @param flatness The largest deviation allowed.
/// @throws std::invalid_argument if a facet is no polygon that lies in a plane; names
/// the facet, and where.
[[nodiscard]] TriangulatedFacets triangulated_facets(std::span<const Vector<3>> points,
                                                     const FacetLoops &facets,
                                                     std::span<const Segment> edges,
                                                     double flatness);

} // namespace anistar::generate
