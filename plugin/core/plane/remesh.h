#pragma once
// remesh: a mesh, a metric field, and a geometry in; a mesh with unit edges out.

#include "metric/background.h"
#include "plane/geometry/curves.h"
#include "remesh/remesh_result.h"
#include "remesh/remesh_settings.h"

namespace anistar {

/// @param background the input mesh with its metric
/// @param geometry the mesh whose facets are the shape
/// @throws std::invalid_argument, MeshingError, and what the progress callback throws
[[nodiscard]] RemeshResult<2> remesh(const Background<2> &background,
                                     const GeometryInput &geometry,
                                     const Projection &projection,
                                     const RemeshSettings &settings,
                                     Monitor::Progress progress);

} // namespace anistar
