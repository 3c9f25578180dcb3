#pragma once
// The local test of the certificate in 3D: whether five metrics agree about a facet.

#include "mesh/measures.h"

#include <array>

namespace anistar {

/// The facet abc of the positive cell abcd and the vertex e on its other side.
using FacetStar = std::array<const Vertex<3> *, 5>;

/// The largest, over the metrics M of the five vertices, of the in-sphere determinant
/// det [x_i - e | (x_i - e)^T M (x_i - e)] relative to the sum of the magnitudes of the
/// terms of its expansion. Positive, exactly, when e lies inside the circumball of abcd
/// in one of the metrics: then a cell at the facet is not Delaunay in the metric of one
/// of its vertices. Ties are negative.
///
/// The determinant is linear in M: it is <M, K> with K = sum_i cof_i u_i u_i^T, one
/// tensor for all five.
[[nodiscard]] double facet_margin(const FacetStar &star);

/// The margin in the metric that gives the largest one, without exact arithmetic, and
/// its gradient with respect to the place of one of the five. The metrics and the size
/// that the margin is relative to are taken as they are.
struct FacetSlope {
  double margin;
  Vector<3> gradient;
};
/// @param moved the index of the vertex that moves, in the star
[[nodiscard]] FacetSlope facet_slope(const FacetStar &star, std::size_t moved);

} // namespace anistar
