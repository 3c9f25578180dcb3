#pragma once
// Whether the metrics around an edge agree that it is Delaunay.

#include "mesh/triangulation.h"

namespace anistar {

/// Whether an edge is not Delaunay in the metric of one of the four vertices of its two
/// cells: the local test, necessary for a certificate (the in-sphere determinant is
/// linear in the metric, so one coefficient vector serves all four).
[[nodiscard]] bool disagrees(const Triangulation<2> &mesh, HalfFacet edge);

/// The same for the edge ab with c on its left and e on its right.
[[nodiscard]] bool metrics_disagree(const Vertex<2> &a, const Vertex<2> &b,
                                    const Vertex<2> &c, const Vertex<2> &e);

} // namespace anistar
