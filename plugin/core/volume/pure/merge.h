#pragma once
// From consistent stars to one mesh.

#include "volume/pure/star_set.h"

namespace anistar {

/// What keeps consistent stars from being a mesh of the domain.
enum class MergeObstacle {
  nothing,
  unused_site,       ///< no cell has it
  overlapping_cells, ///< three at a facet, or two on one side of it
  bare_facet,        ///< of the boundary, or between regions, and in no surface star
  loose_facet,       ///< in a surface star and of no cell
  lost_ridge,        ///< an edge of one is no edge of a cell
};

struct MergedMesh {
  Triangulation<3> mesh{}; ///< the constraint of a facet is its patch
  std::vector<RidgeEdge> ridges{};
  MergeObstacle obstacle = MergeObstacle::nothing;
  std::vector<Index> defects{}; ///< the sites where it is met
};

/// The union of the restricted stars. That it is a mesh is verified, exactly as far as
/// cells that meet are concerned.
/// @pre the stars are consistent
[[nodiscard]] MergedMesh merge(const StarSet &stars, std::vector<RidgeEdge> ridges);

} // namespace anistar
