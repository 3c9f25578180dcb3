#pragma once
// remesh: a mesh, a metric field, and a geometry in; a mesh with unit edges out.

#include "metric/background.h"
#include "plane/geometry/curves.h"
#include "plane/passes/refine.h"
#include "plane/passes/shaping.h"
#include "remesh/remesh_result.h"
#include "remesh/remesh_settings.h"

namespace anistar {

/// What every remesher returns, with the operations made in the plane.
struct PlaneResult : RemeshResult<2> {
  std::size_t protected_corners = 0, unprotected_corners = 0; ///< sharp ones
  RefineCounts refinement;
  std::optional<ShapeCounts> shape;  ///< where these passes ran
  std::size_t flips = 0, capped = 0; ///< and legalisations that met their bound
};

/// @param background the input mesh with its metric
/// @param geometry the mesh whose facets are the shape
/// @throws std::invalid_argument, MeshingError, and what the progress callback throws
[[nodiscard]] PlaneResult remesh(const Background<2> &background,
                                 const GeometryInput &geometry,
                                 const Projection &projection,
                                 const RemeshSettings &settings,
                                 Monitor::Progress progress);

} // namespace anistar
