#pragma once
// Points at one place.

#include "base/tensor.h"
#include "mesh/adjacency.h"

#include <span>
#include <vector>

namespace anistar::generate {

/// Of each point the first one that is exactly where it is, itself if there is none
/// before.
[[nodiscard]] std::vector<Index> first_at_place(std::span<const Vector<3>> points);

} // namespace anistar::generate
