#pragma once
// How far a metric field reaches before it has changed too much.

#include "metric/background.h"

namespace anistar {

/// The distance l, in the metric at x, up to which the metric varies by at most
/// gamma_0: the bounded distortion radius (RR-7712 v2, section 2.3), estimated from
/// samples on ellipsoids around x; the field is P1, so that samples at half the size of
/// its cells miss little.
template <std::size_t d>
[[nodiscard]] double bounded_distortion_radius(const Background<d> &background,
                                               const Vertex<d> &at, Index cell,
                                               double gamma_0);

} // namespace anistar
