#pragma once
// A quick answer for pieces that a plane of one of them clearly keeps apart.

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
      : points_(points), pieces_(pieces) {
    planes_.reserve(pieces.size());
    for (const Piece &piece : pieces)
      planes_.push_back(piece.is_triangle() ? plane_of(piece, gap) : Plane{});
  }

  /// Whether they are certainly apart; otherwise it is not known.
  /// @pre They share no point.
  [[nodiscard]] bool is_certain(Index a, Index b) const {
    return is_beside(pieces_[a], pieces_[b], planes_[b]) ||
           is_beside(pieces_[b], pieces_[a], planes_[a]);
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
  std::vector<Plane> planes_;

  [[nodiscard]] Plane plane_of(const Piece &piece, double gap) const {
    const Vector<3> &o = points_[piece.corners[0]];
    const Vector<3> u = points_[piece.corners[1]] - o,
                    v = points_[piece.corners[2]] - o;
    const Vector<3> normal = u.cross(v);
    const double lengths = u.norm() * v.norm();
    return {normal, 2 * gap * normal.norm() + detail::underflow_guard, bound * lengths};
  }
  [[nodiscard]] bool is_beside(const Piece &p, const Piece &q,
                               const Plane &plane) const {
    const Vector<3> &o = points_[q.corners[0]];
    bool all_above = true, all_below = true;
    for (const Index v : p.points()) {
      const Vector<3> x = points_[v] - o;
      const double height = plane.normal.dot(x);
      const double margin = plane.margin + plane.error * x.cwiseAbs().sum();
      all_above &= height > margin;
      all_below &= height < -margin;
    }
    return all_above || all_below;
  }
};

} // namespace anistar::generate
