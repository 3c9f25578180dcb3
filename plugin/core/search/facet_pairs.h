#pragma once
// Pairs of facets that may touch or cross.

#include "base/tensor.h"
#include "mesh/adjacency.h"

#include <array>
#include <span>
#include <vector>

namespace anistar {

/// Facets without a line (2D) or plane (3D) clearly between them, each pair once and
/// sorted, among the axes of the separating axis theorem that lie along one of the two:
/// its normal and the normals of its edges in its plane. What touches or crosses,
/// within `contact` times its size, is among them.
template <std::size_t d>
[[nodiscard]] std::vector<std::array<Index, 2>>
close_facets(std::span<const Vector<d>> points, std::span<const Facet<d>> facets,
             double contact);

} // namespace anistar
