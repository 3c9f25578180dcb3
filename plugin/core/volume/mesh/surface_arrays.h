#pragma once
// The surfaces and given ridges of a mesh of tetrahedra, as they leave the core.

#include "surface/ridge_graph.h"
#include "surface/surface_input.h"
#include "volume/mesh/volume.h"

#include <span>
#include <vector>

namespace anistar {

struct SurfaceArrays {
  std::vector<HalfFacet> sides; ///< of every facet, the first one
  std::vector<Facet<3>> facets;
  std::vector<Index> facet_tags;
  std::vector<std::array<Index, 2>> edges; ///< of given ridges
  std::vector<Index> edge_tags;
};

/// @param mesh may have free cells
[[nodiscard]] SurfaceArrays surface_arrays(const Triangulation<3> &mesh,
                                           std::span<const RidgeEdge> ridges,
                                           const SurfaceShape &surface);

} // namespace anistar
