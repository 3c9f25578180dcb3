#pragma once
// How a smooth surface, or a curve in the plane, bulges over a facet that samples it.
//
// Over the plane of the facet it is the quadratic that vanishes at the vertices and is
// as high over the middle of each edge as the circle through its ends that turns with
// the normals there. On planes, spheres and circular cylinders these heights are
// exact; elsewhere the quadratic differs from the surface in the third order of the
// size of the facet.

#include "certificate/surface/surface_facet.h"
#include "mesh/measures.h"

namespace anistar {

/// The height over the middle of the edge opposite each vertex, in 2D over the middle
/// of the facet; positive where the normal of the facet points (see surface_facet.h).
template <std::size_t d> using FacetBulge = std::array<double, d == 2 ? 1 : 3>;

/// @param normals of the surface at the vertices, of unit length, in either direction
template <std::size_t d>
[[nodiscard]] FacetBulge<d> facet_bulge(const std::array<Vector<d>, d> &corners,
                                        const std::array<Vector<d>, d> &normals);

/// The shift (see surface_facet.h) that takes the centre of a ball to the surface; NaN
/// where the line of the centres does not meet it.
/// @param corners, bulge with the vertex whose metric is M first
template <std::size_t d>
[[nodiscard]] double surface_shift(const SymmetricTensor<d> &M,
                                   const std::array<Vector<d>, d> &corners,
                                   const FacetBulge<d> &bulge);

/// The M-surface ball of a facet, rounded. @pre its shift is a number
template <std::size_t d>
[[nodiscard]] Circumsphere<d> surface_sphere(const SymmetricTensor<d> &M,
                                             const SurfaceFacet<d> &facet);

/// The same facet with another vertex first.
template <class Array>
[[nodiscard]] Array turned(const Array &of_corners, std::size_t first) {
  Array out;
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = of_corners[(first + k) % out.size()];
  return out;
}

} // namespace anistar
