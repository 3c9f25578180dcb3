#pragma once
// How far a smooth shape lies from the chords that sample it, as their turns tell.
//
// It does not ask which smooth shape: where one turn is far larger than those around
// it, as at a corner that is taken for smooth, the shape that is put across it lies
// farther off than this.

#include "base/tensor.h"
#include "mesh/adjacency.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace anistar {

/// Curvatures change from chord to chord by less than this factor where chords sample a
/// smooth shape.
inline constexpr double largest_curvature_growth = 1.5;

/// The curvature that a turn gives, as far as the largest of those around it bears it
/// out.
/// @param around negative where nothing is known
[[nodiscard]] inline double borne_out(double curvature, double around) {
  return around < 0 ? curvature
                    : std::min(curvature, largest_curvature_growth * around);
}

/// For every segment of a set of polylines how far their smooth curve lies from it.
/// @param is_smooth where exactly two segments meet and the curve goes on smoothly
template <std::size_t d>
[[nodiscard]] std::vector<double>
polyline_sags(std::span<const Vector<d>> points,
              std::span<const std::array<Index, 2>> segments,
              const std::vector<bool> &is_smooth);

} // namespace anistar
