#pragma once
// A quick answer for pieces that the plane of one of them, or one through an edge of
// it, clearly keeps apart.

#include "base/predicates.h"
#include "generate/checking/piece.h"

#include <limits>
#include <span>
#include <vector>

namespace anistar::generate {

/// The planes of triangles, rounded, with a bound of what that is off by.
class Separation {
public:
  /// Pieces that are kept apart are farther than `gap` from each other.
  Separation(std::span<const Vector<3>> points, std::span<const Piece> pieces,
             double gap)
      : points_(points), pieces_(pieces), gap_(gap) {
    planes_.reserve(pieces.size());
    for (const Piece &piece : pieces)
      planes_.push_back(piece.is_triangle() ? plane_of(piece) : Plane{});
  }

  /// Whether they are certainly apart; otherwise it is not known.
  /// @pre They share no point.
  [[nodiscard]] bool is_certain(Index a, Index b) const {
    return is_beside(a, b) || is_beside(b, a) || is_past_edge(a, b) ||
           is_past_edge(b, a);
  }

private:
  struct Plane {
    Vector<3> normal = Vector<3>::Zero();
    double margin = std::numeric_limits<double>::infinity(); ///< of heights
    double error = 0; ///< of a height, by the distance from the first corner
  };
  /// Of a determinant, in products of the lengths of its columns: as those of the exact
  /// predicates, where a product is at most that of the lengths and there are six.
  static constexpr double bound =
      6 * detail::orientation_bound_3 + 16 * detail::round_off;

  std::span<const Vector<3>> points_;
  std::span<const Piece> pieces_;
  double gap_;
  std::vector<Plane> planes_;

  [[nodiscard]] Plane plane_of(const Piece &piece) const {
    const Vector<3> &o = points_[piece.corners[0]];
    const Vector<3> u = points_[piece.corners[1]] - o,
                    v = points_[piece.corners[2]] - o;
    const Vector<3> normal = u.cross(v);
    const double lengths = u.norm() * v.norm();
    return {normal, 2 * gap_ * normal.norm() + detail::underflow_guard,
            bound * lengths};
  }
  /// Whether a piece is on one side of the plane of q.
  [[nodiscard]] bool is_beside(Index p, Index q) const {
    const Plane &plane = planes_[q];
    const Vector<3> &o = points_[pieces_[q].corners[0]];
    bool all_above = true, all_below = true;
    for (const Index v : pieces_[p].points()) {
      const Vector<3> x = points_[v] - o;
      const double height = plane.normal.dot(x);
      const double margin = plane.margin + plane.error * x.cwiseAbs().sum();
      all_above &= height > margin;
      all_below &= height < -margin;
    }
    return all_above || all_below;
  }
  /// Whether a piece is beyond the plane through an edge of q and the normal of q.
  [[nodiscard]] bool is_past_edge(Index p, Index q) const {
    if (!pieces_[q].is_triangle())
      return false;
    const Plane &plane = planes_[q];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = pieces_[q].edge(k);
      const Vector<3> edge = points_[b] - points_[a];
      const Vector<3> inward = plane.normal.cross(edge);
      const double margin = 2 * gap_ * inward.norm() + detail::underflow_guard;
      const double error = plane.error * edge.norm();
      bool all_outside = true;
      for (const Index v : pieces_[p].points()) {
        const Vector<3> x = points_[v] - points_[a];
        all_outside &= inward.dot(x) < -margin - error * x.cwiseAbs().sum();
      }
      if (all_outside)
        return true;
    }
    return false;
  }
};

} // namespace anistar::generate
