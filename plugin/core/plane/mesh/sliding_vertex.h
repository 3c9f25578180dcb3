#pragma once
// A vertex that slides along its curve.

#include "plane/mesh/workspace.h"

namespace anistar {

/// A vertex on a curve, between its two edges of the curve.
class SlidingVertex {
public:
  /// @param star the star of v
  SlidingVertex(Workspace &w, std::span<const HalfFacet> star, Index v);

  /// False at the ends of curves and on frozen ones.
  [[nodiscard]] bool is_on_curve() const { return in_ != none && out_ != none; }
  /// False also on the shell of a corner, whose vertices move only together.
  [[nodiscard]] bool can_slide() const {
    return is_on_curve() && in().ball == none && out().ball == none;
  }
  [[nodiscard]] const CurveEdge &in() const { return edge(in_); }
  [[nodiscard]] const CurveEdge &out() const { return edge(out_); }
  [[nodiscard]] double room_before() const { return in().t1 - in().t0; }
  [[nodiscard]] double room_after() const { return out().t1 - out().t0; }
  [[nodiscard]] Vector<2> at(double dt) const;
  /// The two edges keep to the curve within the Hausdorff bound and meet no other part
  /// of the boundary. @pre v is where in().t1 says.
  [[nodiscard]] bool may_slide(double dt) const;
  /// Tells the curve edges; the caller moves the vertex.
  void commit(double dt) const;

private:
  Workspace &w_;
  Index in_ = none, out_ = none; ///< entries of the table of curve edges

  [[nodiscard]] bool is_clear(const Vector<2> &x) const;
  [[nodiscard]] CurveEdge &edge(Index k) const { return w_.on_curves.curve_edges[k]; }
};

} // namespace anistar
