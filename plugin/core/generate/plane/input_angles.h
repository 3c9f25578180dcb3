#pragma once
// The angles between segments of the input, which no refinement can make larger.

#include "generate/plane/planar_complex.h"

namespace anistar::generate {

/// Knows where segments meet at less than 60 degrees.
class InputAngles {
public:
  InputAngles(std::span<const Vector<2>> points, std::span<const Segment> segments);

  /// Whether a point of the input is the apex of a small angle.
  [[nodiscard]] bool is_apex(Index v) const { return is_apex_[v]; }
  /// Segments at a point of the input.
  [[nodiscard]] std::span<const Index> segments_at(Index v) const {
    return std::span(incident_).subspan(starts_[v], starts_[v + 1] - starts_[v]);
  }
  [[nodiscard]] std::span<const Vector<2>> points() const { return points_; }
  [[nodiscard]] std::span<const Segment> segments() const { return segments_; }

private:
  std::span<const Vector<2>> points_;
  std::span<const Segment> segments_;
  std::vector<std::size_t> starts_;
  std::vector<Index> incident_;
  std::vector<bool> is_apex_;

  [[nodiscard]] Vector<2> arm(Index v, Index segment) const;
  [[nodiscard]] bool has_small_angle(Index v);
};

/// Square of the cosine of an angle; the angle is less than 90 degrees.
inline constexpr double square_of_cos_60 = .25;
/// Of 15 degrees, rounded.
inline constexpr double square_of_cos_15 = .9330127018922193;

/// Whether the angle between two directions is less than one of that cosine.
[[nodiscard]] inline bool is_smaller(const Vector<2> &u, const Vector<2> &v,
                                     double square_of_cos) {
  const double along = u.dot(v);
  return along > 0 && along * along > square_of_cos * u.squaredNorm() * v.squaredNorm();
}

} // namespace anistar::generate
