#pragma once
// remesh in 3D: a mesh, a metric field and a geometry in; a mesh with unit edges out.

#include "remesh/remesh_result.h"
#include "remesh/remesh_settings.h"
#include "volume/mesh/start.h"
#include "volume/passes/passes.h"

namespace anistar {

/// What every remesher returns, with the ridges that were given and the operations made
/// in space.
struct VolumeResult : RemeshResult<3> {
  std::vector<std::array<Index, 2>> edges;
  std::vector<Index> edge_tags;
  bool is_curved = false; ///< some surface or ridge is
  VolumeCounts passes;
  /// Of the star set, where the algorithm of the paper alone was asked for: the mesh is
  /// the union of the stars if it was consistent.
  std::optional<std::size_t> n_sites;
};

/// @param metric at the points of the input mesh, which carry it from then on
/// @param geometry surfaces and ridges that the new mesh follows
/// @throws std::invalid_argument, and what the progress callback throws
[[nodiscard]] VolumeResult
remesh_volume(const VolumeInput &input, std::span<const SymmetricTensor<3>> metric,
              const SurfaceInput &geometry, SurfaceProjection projection,
              const RemeshSettings &settings, Monitor::Progress progress);

} // namespace anistar
