#pragma once
// Steps by which smoothing draws a vertex to a better place.

#include "mesh/triangulation.h"

namespace anistar {

/// The step of Bossen and Heckbert's pliant forces towards unit edges.
[[nodiscard]] Vector<2> pliant_displacement(const Triangulation<2> &mesh,
                                            const Vertex<2> &v,
                                            std::span<const HalfFacet> star);

/// The step towards the optimal Delaunay triangulation: the mean of the circumcentres
/// of the star, weighted by area.
[[nodiscard]] Vector<2> odt_displacement(const Triangulation<2> &mesh,
                                         const Vertex<2> &v,
                                         std::span<const HalfFacet> star);

} // namespace anistar
