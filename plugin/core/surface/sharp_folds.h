#pragma once
// Which edges of a surface are ridges by the angle that it turns by there.

#include "surface/surface_input.h"

#include <vector>

namespace anistar {

/// An edge between two facets with the same tag, and the angle in degrees by which the
/// surface turns there.
struct Fold {
  std::array<Index, 2> ends; ///< in increasing order
  std::array<std::size_t, 2> facets;
  double turn;
};

/// Ridges by hysteresis. A fold is one when it turns by the ridge angle, or by a third
/// of it in a chain of folds that turn several times as much as all others around
/// (after Jiao and Heath, Feature detection for surface meshes, 2002). And it is one
/// where a ridge ends and it goes on in nearly the same direction, turned clearly more
/// than what is around. So a ridge is followed to where it fades out, and a smooth
/// surface of few facets, where all folds turn alike, has none.
/// @param others the other ridges, at which none ends
[[nodiscard]] std::vector<bool>
sharp_folds(const SurfaceInput &input, std::span<const Fold> folds,
            std::span<const std::array<Index, 2>> others);

} // namespace anistar
