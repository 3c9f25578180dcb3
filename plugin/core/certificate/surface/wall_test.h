#pragma once
// The local test of surface stars in 3D: whether the cells at a facet of a surface
// leave its surface balls empty.

#include "certificate/surface/surface_facet.h"
#include "mesh/measures.h"

#include <array>

namespace anistar {

/// What decides about a facet abc of a surface.
struct WallStar {
  std::array<const Vertex<3> *, 3> corners;
  /// Of the cells at the facet; the second one is null on the boundary.
  std::array<const Vertex<3> *, 2> apexes;
  /// Of the surface at the corners, of unit length; null where it is a plane, or none
  /// is known.
  std::array<const Vector<3> *, 3> normals{};
};

/// The facet as each of its corners sees it; NaN as a shift where no ball of a corner
/// goes through it.
[[nodiscard]] std::array<SurfaceFacet<3>, 3> surface_facets(const WallStar &star);

/// The largest, over the metrics M of the corners and over the apexes, of what the
/// power of an apex in the M-surface ball of the facet (see surface_facet.h) is short
/// of zero, relative to the magnitudes of its terms. Positive when an apex lies inside:
/// then the facet is not in the surface star of one of its vertices. Ties are negative.
/// Small margins have the exact sign for the rounded shift; it is the certificate that
/// decides.
[[nodiscard]] double wall_margin(const WallStar &star);

} // namespace anistar
