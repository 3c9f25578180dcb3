#pragma once
// Facets that are triangles of a surface, as loops of points.

#include "base/tensor.h"
#include "mesh/adjacency.h"

#include <cstdint>
#include <span>
#include <vector>

namespace anistar::generate {

/// What FacetLoops looks at.
struct SurfaceLoops {
  std::vector<Index> indices;
  std::vector<std::int64_t> loop_starts{0}, facet_starts{0};
};

/// The loops around each facet: first the one that encloses most, turned as the first
/// triangle there, then holes, then inner points as loops of their own.
/// @param owners The facet of each triangle.
[[nodiscard]] SurfaceLoops surface_loops(std::span<const Vector<3>> points,
                                         std::span<const Facet<3>> triangles,
                                         std::span<const Index> owners,
                                         std::size_t n_facets);

} // namespace anistar::generate
