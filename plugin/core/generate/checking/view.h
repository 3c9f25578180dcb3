#pragma once
// A view along an axis, in which points of one plane or line keep their order.

#include "base/predicates.h"

#include <cmath>
#include <optional>

namespace anistar::generate {

/// The plane of the two coordinates that follow `axis`, and how three points turn in
/// it.
struct View {
  int axis;
  Orientation turn; ///< of the points that the view was chosen for

  [[nodiscard]] Vector<2> seen(const Vector<3> &x) const {
    return {x[(axis + 1) % 3], x[(axis + 2) % 3]};
  }
  [[nodiscard]] Orientation side(const Vector<3> &a, const Vector<3> &b,
                                 const Vector<3> &c) const {
    return orientation(seen(a), seen(b), seen(c));
  }
};

/// The view in which a, b, c are largest; none when they are exactly on one line.
[[nodiscard]] inline std::optional<View> view_of(const Vector<3> &a, const Vector<3> &b,
                                                 const Vector<3> &c) {
  const Vector<3> normal = (b - a).cross(c - a).cwiseAbs();
  int best = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (normal[axis] > normal[best])
      best = axis;
  for (int k = 0; k < 3; ++k) {
    View view{(best + k) % 3, Orientation::degenerate};
    view.turn = view.side(a, b, c);
    if (view.turn != Orientation::degenerate)
      return view;
  }
  return std::nullopt;
}

} // namespace anistar::generate
