#include "generate/plane/input_angles.h"

#include "base/predicates.h"

#include <algorithm>

namespace anistar::generate {
namespace {

/// Whether a direction is in the upper half of the plane, or to the right.
bool is_upper(const Vector<2> &u) { return u[1] > 0 || (u[1] == 0 && u[0] > 0); }

} // namespace

InputAngles::InputAngles(std::span<const Vector<2>> points,
                         std::span<const Segment> segments)
    : points_(points), segments_(segments), starts_(points.size() + 1, 0),
      incident_(2 * segments.size()), is_apex_(points.size(), false) {
  for (const Segment &segment : segments)
    for (const Index v : segment)
      ++starts_[v + 1];
  for (std::size_t v = 0; v < points.size(); ++v)
    starts_[v + 1] += starts_[v];
  std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
  for (std::size_t s = 0; s < segments.size(); ++s)
    for (const Index v : segments[s])
      incident_[next[v]++] = static_cast<Index>(s);
  for (std::size_t v = 0; v < points.size(); ++v)
    is_apex_[v] = has_small_angle(static_cast<Index>(v));
}

Vector<2> InputAngles::arm(Index v, Index segment) const {
  const auto [a, b] = segments_[segment];
  return points_[a == v ? b : a] - points_[v];
}

/// Sorts the segments around v: the smallest angle is between two that follow each
/// other.
bool InputAngles::has_small_angle(Index v) {
  const auto around = std::span(incident_).subspan(starts_[v], segments_at(v).size());
  if (around.size() < 2)
    return false;
  const Vector<2> &x = points_[v];
  const auto end = [&](Index s) { return segments_[s][segments_[s][0] == v ? 1 : 0]; };
  std::sort(around.begin(), around.end(), [&](Index s, Index t) {
    const bool upper_s = is_upper(arm(v, s)), upper_t = is_upper(arm(v, t));
    if (upper_s != upper_t)
      return upper_s;
    return orientation(x, points_[end(s)], points_[end(t)]) == Orientation::positive;
  });
  for (std::size_t k = 0; k < around.size(); ++k)
    if (is_smaller(arm(v, around[k]), arm(v, around[(k + 1) % around.size()]),
                   square_of_cos_60))
      return true;
  return false;
}

} // namespace anistar::generate
