#pragma once
// From the arrays of a mesh to a volume that can be changed.

#include "surface/surface_features.h"
#include "volume/mesh/volume.h"

namespace anistar {

/// The mesh to start from.
struct VolumeInput {
  std::span<const Cell<3>> cells;
  std::span<const Index> cell_tags;
  SurfaceInput surface; ///< every boundary and interface facet is among its facets
};

/// @param geometry gives the shape of curved patches and ridges
/// @throws std::invalid_argument when a facet is not one of a cell
[[nodiscard]] Volume make_volume(const VolumeInput &input,
                                 std::span<const SymmetricTensor<3>> metric,
                                 const Background<3> &background,
                                 const SurfaceInput &geometry,
                                 SurfaceProjection projection);

} // namespace anistar
