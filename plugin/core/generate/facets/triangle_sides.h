#pragma once
// How the triangles of a surface meet, which need not be a manifold.

#include "mesh/adjacency.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace anistar::generate {

/// The triangle across a side.
struct AcrossSide {
  Index triangle = none;   ///< none unless exactly two triangles share the side
  std::uint8_t corner = 0; ///< of that triangle, opposite the side
  bool is_turned = false;  ///< both go along the side in one direction
};

/// Of each triangle, across the side opposite each corner.
using SidesOfTriangle = std::array<AcrossSide, 3>;

[[nodiscard]] std::vector<SidesOfTriangle>
triangle_sides(std::span<const Facet<3>> triangles, std::size_t n_points);

} // namespace anistar::generate
