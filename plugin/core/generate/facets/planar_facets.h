#pragma once
// What is planar in a surface of triangles.

#include "base/tensor.h"
#include "mesh/adjacency.h"

#include <span>
#include <vector>

namespace anistar::generate {

/// What counts as planar.
struct Planarity {
  double sine;     ///< of the largest angle to the plane
  double distance; ///< the largest of a point from the plane
  /// What the coordinates are rounded by: a triangle that rises by less over the plane
  /// may make any angle with it.
  double rounding;
};

/// The planar facet of each triangle, numbered in the order of their first triangles.
///
/// A facet grows from its largest triangle across edges between exactly two triangles,
/// both of one tag, as long as these are planar with that first one; measured against
/// their neighbours alone the facets of a fine sphere would be one. Then it grows once
/// more from the mean plane of what was found, as long as that takes more. The largest
/// triangles of all start first.
[[nodiscard]] std::vector<Index> planar_facets(std::span<const Vector<3>> points,
                                               std::span<const Facet<3>> triangles,
                                               std::span<const Index> tags,
                                               const Planarity &planarity);

} // namespace anistar::generate
