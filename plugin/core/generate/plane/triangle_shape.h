#pragma once
// Circumcircles, the ratio that Delaunay refinement bounds, and where it places points.

#include "base/predicates.h"

#include <limits>

namespace anistar::generate {

/// The shape of a triangle abc, rounded: no topology depends on it.
class TriangleShape {
public:
  explicit TriangleShape(const Simplex<2> &s) : s_(s) {
    for (std::size_t i = 0; i < 3; ++i) {
      squares_[i] = (s[(i + 2) % 3] - s[(i + 1) % 3]).squaredNorm();
      if (squares_[i] < squares_[shortest_])
        shortest_ = i;
      if (squares_[i] > squares_[longest_])
        longest_ = i;
    }
    doubled_area_ = cross(s[1] - s[0], s[2] - s[0]);
  }
  /// Which edge, by the vertex opposite it.
  [[nodiscard]] std::size_t shortest() const { return shortest_; }
  [[nodiscard]] double shortest_square() const { return squares_[shortest_]; }
  [[nodiscard]] double longest_square() const { return squares_[longest_]; }
  [[nodiscard]] double radius_square() const {
    return squares_[0] * squares_[1] * squares_[2] /
           (4 * doubled_area_ * doubled_area_);
  }
  /// Square of circumradius over shortest edge.
  [[nodiscard]] double ratio_square() const {
    return radius_square() / shortest_square();
  }
  [[nodiscard]] Vector<2> circumcentre() const {
    const Vector<2> u = s_[1] - s_[0], v = s_[2] - s_[0];
    const double uu = u.squaredNorm(), vv = v.squaredNorm();
    return s_[0] + Vector<2>(v[1] * uu - u[1] * vv, u[0] * vv - v[0] * uu) /
                       (2 * doubled_area_);
  }
  /// The circumcentre, or if it is further than needed from the shortest edge the point
  /// on the way there that makes a triangle with it of a ratio (Uengoer, Off-centers: a
  /// new type of Steiner points, 2004).
  [[nodiscard]] Vector<2> off_centre(double ratio) const {
    const Vector<2> centre = circumcentre();
    const Vector<2> &p = s_[(shortest_ + 1) % 3], &q = s_[(shortest_ + 2) % 3];
    const Vector<2> middle = .5 * (p + q), way = centre - middle;
    const double enough =
        std::sqrt(shortest_square()) * (ratio + std::sqrt(ratio * ratio - .25));
    const double length = way.norm();
    return length > enough ? Vector<2>(middle + (enough / length) * way) : centre;
  }

private:
  const Simplex<2> &s_;
  std::array<double, 3> squares_{};
  std::size_t shortest_ = 0, longest_ = 0;
  double doubled_area_;
};

} // namespace anistar::generate
