#pragma once
// The curves of a domain, cut into edges of unit metric length.

#include "base/run.h"
#include "mesh/triangulation.h"
#include "metric/background.h"
#include "plane/geometry/curves.h"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace anistar {

/// An edge of the mesh that is part of a curve, in the direction of the curve: what the
/// constraint of a facet refers to.
struct CurveEdge {
  Index curve;
  double t0, t1; ///< curve parameters of its ends
  Index v0, v1;
  Index ball = none; ///< the protecting ball that it crosses from corner to shell

  /// What is left of it before and after a vertex v at t; in no ball.
  [[nodiscard]] CurveEdge before(double t, Index v) const {
    return {.curve = curve, .t0 = t0, .t1 = t, .v0 = v0, .v1 = v};
  }
  [[nodiscard]] CurveEdge after(double t, Index v) const {
    return {.curve = curve, .t0 = t, .t1 = t1, .v0 = v, .v1 = v1};
  }
};

/// Vertices and edges on the curves, plus the points that must stay.
struct Outline {
  std::vector<Vertex<2>> vertices;
  std::vector<Index> feature;    ///< dimension of the feature a vertex lies on
  std::vector<Index> background; ///< where its metric was found
  std::vector<CurveEdge> edges;
  std::vector<FreePoint> free_points; ///< `point` is a vertex here
  std::size_t n_balls = 0;            ///< protecting balls of sharp corners
  std::size_t n_unprotected = 0;      ///< sharp corners without one
};

/// Cuts every curve into edges of equal metric length near 1, each of which keeps to
/// the curve within the Hausdorff bound of the run; frozen curves keep their points.
/// @throws BudgetSpent when the time is up, or the metric asks for more vertices than
/// the monitor allows
/// @throws MeshingError when it asks for more than can be numbered, or a projection
/// tears a curve apart
[[nodiscard]] Outline make_outline(const Geometry &geometry,
                                   const Background<2> &background, const Run &run);

/// Cuts the curves at points of the geometry: at all, or where the monitor has no room
/// for so many at as few as keep the curves within that bound. This is what is made
/// when a budget does not allow unit edges: it asks no projection and takes no longer
/// than reading the geometry.
[[nodiscard]] Outline outline_at_points(const Geometry &geometry,
                                        const Background<2> &background,
                                        const Run &run);

/// Brings edges nearer to the geometry's own polyline, which is valid: an edge that
/// spans points of the geometry is split at one, another becomes a piece of a straight
/// segment. A protecting ball whose shell would not stay one is given up.
/// @param look is called now and then; what it throws comes through
/// @returns whether anything changed.
bool retreat(Geometry &geometry, const Background<2> &background, Outline &outline,
             const std::vector<Index> &edges, const std::function<void()> &look);

/// The protecting balls that the edges cross.
[[nodiscard]] std::size_t count_balls(std::span<const CurveEdge> edges);

/// Edges that part x from its place beside the geometry's polyline: x lies between them
/// and the polyline.
[[nodiscard]] std::vector<Index>
edges_before(const Geometry &geometry, const Outline &outline, const Vector<2> &x);

/// Edges that meet others anywhere but at a common end, or a free point.
/// @param look is called now and then; what it throws comes through
[[nodiscard]] std::vector<Index> conflicts(const Outline &outline,
                                           const std::function<void()> &look);

} // namespace anistar
