#pragma once
// A facet of a surface as the star of one of its vertices sees it.
//
// The surface star T_v of a vertex v has the facets t at v whose dual edge in the
// Voronoi diagram of the metric M of v meets the surface: an M-ball through the
// vertices of t, centred on the surface, is empty. It is an M-surface Delaunay ball
// (Boissonnat, Wormser, Yvinec, RR-7712 v2, section 7.1).
//
// The M-balls through the vertices of t have their centres on a line. With y the offset
// from v, n the normal of t (in 3D u x w for the edges u, w from v to the next two
// vertices, in 2D the edge turned to the left) and G fixed by the centre in the plane
// of t, their powers are
//     y^T M y - G.y - shift n.y,
// and the centre lies at half the shift times M^-1 n from that plane. On a plane the
// shift is zero, and the ball is a polynomial in the coordinates and in M. Elsewhere
// the shift is a stored double that takes the centre to the surface (see
// certificate/surface/facet_bulge.h), and the ball that it gives is tested as exactly.

#include "base/tensor.h"

#include <array>

namespace anistar {

template <std::size_t d> struct SurfaceFacet {
  std::array<Vector<d>, d> corners; ///< v first, in the cyclic order of the facet
  double shift = 0;                 ///< in 1 / length^d
};

} // namespace anistar
