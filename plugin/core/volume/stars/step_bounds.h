#pragma once
// Directed steps: what a step of a vertex must satisfy, as far as slopes tell.

#include "volume/stars/moving_vertex.h"

namespace anistar {

/// value + slope . y <= 0 for the step y.
struct LinearBound {
  double value;
  Vector<3> slope;
  bool is_wish = false; ///< it does not hold yet, and may be given up

  [[nodiscard]] double excess(const Vector<3> &y) const { return value + slope.dot(y); }
};

/// The point nearest to `wanted`, or nearly so, that satisfies the bounds, as far as
/// there is one within a radius of zero: from one violated bound to the next by
/// projection (Kaczmarz, Angenaeherte Aufloesung von Systemen linearer Gleichungen,
/// 1937).
[[nodiscard]] Vector<3> project(std::span<const LinearBound> bounds,
                                const Vector<3> &wanted, double radius);

/// The bounds of the steps of a vertex. Steps are in coordinates in which the metric of
/// the vertex is the identity; on a surface or ridge they are tangential.
class StepBounds {
public:
  /// Takes up a vertex, which is at home. There are no bounds yet.
  void begin(const Volume &volume, const MovingVertex &vertex);
  /// No facet fails, by a little; those that nearly fail keep half of their margin.
  void keep_facets(const MovingVertex &vertex);
  /// No cell falls below the floor.
  void keep_qualities(const Volume &volume, MovingVertex &vertex, double floor);
  /// Edges of about unit length stay so, others become no worse.
  void keep_lengths(const Volume &volume, const MovingVertex &vertex);

  /// Gives up the wish that y misses by most, if another is left and it misses one.
  [[nodiscard]] bool give_up(const Vector<3> &y);
  [[nodiscard]] Vector<3> nearest(const Vector<3> &wanted, double radius) const {
    return project(bounds_, wanted, radius);
  }
  /// The step in space.
  [[nodiscard]] Vector<3> in_space(const Vector<3> &y) const { return axes_ * y; }

private:
  Matrix<3> axes_; ///< of the coordinates, in space
  std::vector<LinearBound> bounds_;
  std::array<std::vector<double>, 3> quality_slopes_;

  [[nodiscard]] FacetSlope slope_of(const FacetStar &star,
                                    const Vertex<3> *moved) const;
  [[nodiscard]] FacetSlope slope_of(const WallStar &star, const Vertex<3> *moved) const;
};

} // namespace anistar
