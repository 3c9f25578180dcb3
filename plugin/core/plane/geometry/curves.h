#pragma once
// The boundary and the interfaces of a 2D domain as smooth curves between corners.

#include "base/tensor.h"
#include "mesh/adjacency.h"
#include "remesh/domain_shape.h"

#include <functional>
#include <span>
#include <vector>

namespace anistar {

/// Moves a point onto the user's own geometry; gets the point and the facet tag.
using Projection = std::function<Vector<2>(const Vector<2> &, Index)>;

/// What the user gave: a mesh whose facets are the geometry.
struct GeometryInput {
  std::span<const Vector<2>> points;
  std::span<const Cell<2>> cells;
  std::span<const Index> cell_tags;
  std::span<const Facet<2>> facets;
  std::span<const Index> facet_tags;
  std::span<const Index> corners; ///< points that must stay
  DomainShape shape;
};

/// No region: the outside of the domain.
inline constexpr Index no_region = -1;

/// A chain of facets with one tag and the same regions on its two sides. The curve is
/// C1: cubic Hermite between the geometry's points with the tangents of the circles
/// through three of them, exact where three points lie on a line.
class Curve {
public:
  std::vector<Index> vertices; ///< geometry points; front == back on a loop
  Index tag = 0;
  Index left = no_region, right = no_region; ///< cell tags beside it
  bool is_frozen = false;
  bool is_loop = false; ///< closed, without a corner

  [[nodiscard]] std::size_t n_segments() const { return vertices.size() - 1; }
  /// The domain lies on one side only.
  [[nodiscard]] bool is_boundary() const {
    return left == no_region || right == no_region;
  }

  /// The point at parameter t: segment floor(t), fraction t - floor(t).
  [[nodiscard]] Vector<2> at(double t) const;
  /// The same on the geometry's own polyline.
  [[nodiscard]] Vector<2> on_polyline(double t) const;
  /// d at / dt.
  [[nodiscard]] Vector<2> derivative(double t) const;

  [[nodiscard]] bool is_straight(std::size_t k) const { return is_straight_[k]; }
  /// Fixes the shape. @pre `points` hold the positions of `vertices`.
  void fit(std::vector<Vector<2>> points, const Projection *projection);
  /// Replaces segment k by its chord, which no projection moves any more.
  void straighten(std::size_t k) { is_straight_[k] = is_chord_[k] = true; }

private:
  struct OnSegment { ///< a place of the curve
    std::size_t segment;
    double fraction;
  };
  std::vector<Vector<2>> points_;
  std::vector<Vector<2>> start_, end_; ///< Hermite derivatives of each segment
  std::vector<bool> is_straight_, is_chord_;
  const Projection *projection_ = nullptr;

  [[nodiscard]] OnSegment on_segment(double t) const;
  /// Whether another segment ends where segment k begins, and which.
  [[nodiscard]] bool is_joint(std::size_t k) const { return k > 0 || is_loop; }
  [[nodiscard]] std::size_t before(std::size_t k) const {
    return k > 0 ? k - 1 : n_segments() - 1;
  }
  void mark_straight_runs(const std::vector<Vector<2>> &chord);
  [[nodiscard]] std::vector<Vector<2>>
  tangents(const std::vector<Vector<2>> &chord) const;
};

/// A point that must stay and is on no curve.
struct FreePoint {
  Index point, region;
};

struct Geometry {
  std::vector<Vector<2>> points;
  std::vector<Curve> curves;
  std::vector<bool> is_corner; ///< per point of the geometry
  std::vector<FreePoint> free_points;
};

/// Cuts the facets into curves at corners: where other than two facets meet, tags or
/// regions change, the chain turns by the ridge angle or far more than beside it, two
/// straight runs meet, or the caller says so.
/// @throws std::invalid_argument for a facet that is no facet of a cell.
[[nodiscard]] Geometry make_geometry(const GeometryInput &input,
                                     const Projection *projection);

/// The parameter at which the curve is equally far from the two ends of the edge.
[[nodiscard]] double middle(const Curve &curve, double t0, double t1);

/// Distance of the curve from the chord over [t0, t1], relative to the chord's length.
[[nodiscard]] double relative_sagitta(const Curve &curve, double t0, double t1);

} // namespace anistar
