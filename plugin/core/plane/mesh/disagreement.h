#pragma once
// Whether the metrics around an edge agree that it is Delaunay, or in surface stars.

#include "mesh/triangulation.h"

namespace anistar {

/// Whether an edge is not Delaunay in the metric of one of the four vertices of its two
/// cells: the local test, necessary for a certificate (the in-sphere determinant is
/// linear in the metric, so one coefficient vector serves all four). An edge of a curve
/// disagrees when a vertex across it lies in a surface ball of its ends.
[[nodiscard]] bool disagrees(const Triangulation<2> &mesh, HalfFacet edge);

/// The same for the edge ab with c on its left and e on its right.
[[nodiscard]] bool metrics_disagree(const Vertex<2> &a, const Vertex<2> &b,
                                    const Vertex<2> &c, const Vertex<2> &e);

/// Whether c, on either side of the edge ab of a curve, lies inside the ball through a
/// and b, in the metric of one of them, that is centred on the edge: there c sees them
/// at an obtuse angle. What the curve bulges over an edge is far less than the distance
/// of its cells' vertices.
[[nodiscard]] bool encroaches_on_surface(const Vertex<2> &a, const Vertex<2> &b,
                                         const Vertex<2> &c);

} // namespace anistar
