#pragma once
// Finds what is wrong with the segments of a plane domain before it is meshed.

#include "generate/checking/check.h"

namespace anistar::generate {

/// The same in the plane: whether segments and points meet in nothing but what they
/// share, and whether segments can bound something. Places have a third coordinate, 0.
[[nodiscard]] Problems check_plane(std::span<const Vector<2>> points,
                                   std::span<const Segment> segments,
                                   std::span<const Index> points_kept,
                                   const CheckSettings &settings, Monitor &monitor);

} // namespace anistar::generate
