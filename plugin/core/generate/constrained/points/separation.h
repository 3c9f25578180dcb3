#pragma once
// Whether a cell and a facet are clear of each other.

#include "generate/constrained/points/exact_points.h"

namespace anistar::generate {

/// Whether a plane through three of their vertices has the inside of the cell on one
/// side and the facet not on it.
/// @pre the cell is positively oriented
[[nodiscard]] bool are_separated(const ExactPoints &points, const Cell<3> &cell,
                                 const Facet<3> &facet);

} // namespace anistar::generate
