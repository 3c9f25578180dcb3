#pragma once
// Which folds of a mesh are the ridges of its geometry.

#include "surface/smooth_surface.h"

namespace anistar {

/// The folds of a mesh that are ridges because the geometry has one there. Where all
/// points of the mesh that lie on a curve of the geometry follow one another along
/// edges of the mesh, those edges are ridges, whatever the angle. Where they do not,
/// the mesh was made for another geometry: sharp folds near the curve are ridges.
/// @param folds in the order of their ends
/// @param others, is_sharp see RidgeChoice
[[nodiscard]] std::vector<bool>
matched_ridges(const SmoothSurface &geometry, std::span<const Vector<3>> points,
               std::span<const Fold> folds,
               std::span<const std::array<Index, 2>> others,
               const std::vector<bool> &is_sharp);

} // namespace anistar
