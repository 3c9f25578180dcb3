#pragma once
// What the remeshers of both dimensions return, as Python takes it.

#include "bindings/support/mesh_arrays.h"
#include "plane/remesh.h"
#include "volume/remesh.h"

namespace anistar::bindings {

/// The new mesh as arrays, and what happened.
struct ResultArrays : RemeshRecord {
  nb::ndarray<nb::numpy, double> metric;     ///< (n, d, d), at the points of the mesh
  std::map<std::string, std::size_t> counts; ///< operations by name, and corners
  /// Per cell, see DelaunayBits; none: not certified.
  std::optional<nb::ndarray<nb::numpy, std::uint8_t>> delaunay;
  MeshArrays mesh; ///< without corners

  explicit ResultArrays(PlaneResult &&result);
  explicit ResultArrays(VolumeResult &&result);
};

} // namespace anistar::bindings
