#pragma once
// A mesh on its curves with everything that an edit of it needs.

#include "metric/background.h"
#include "plane/mesh/flips.h"
#include "plane/mesh/start.h"
#include "plane/mesh/walls.h"

namespace anistar {

struct Workspace {
  MeshOnCurves &on_curves;
  const Geometry &geometry;
  const Background<2> &background;
  double hausdorff; ///< bound for the distance of an edge from its curve, relative
  Triangulation<2> &mesh = on_curves.mesh;
  /// Of the calling thread; in a parallel loop each thread has its own.
  Cavity cavity{mesh};
  Legaliser legaliser{mesh};
  Walls walls{mesh, on_curves.curve_edges, geometry};

  [[nodiscard]] const CurveEdge &curve_edge(HalfFacet h) const {
    return on_curves.curve_edges[mesh.constraint(h)];
  }
  [[nodiscard]] const Curve &curve(const CurveEdge &edge) const {
    return geometry.curves[edge.curve];
  }
  [[nodiscard]] double length(HalfFacet edge) const {
    const auto [a, b] = mesh.facet(edge);
    return edge_length(mesh.vertex(a), mesh.vertex(b));
  }
};

/// Sorts the mesh along a Hilbert curve and tells the curve edges.
void renumber(Workspace &w, int threads, double shift = 0);

} // namespace anistar
