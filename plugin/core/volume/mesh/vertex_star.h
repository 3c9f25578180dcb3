#pragma once
// The cells around a vertex: where it may go, and what its cavity may take.

#include "volume/mesh/volume.h"

namespace anistar {

/// Whether the facets of surfaces at v keep their side, and stay near curved ones, when
/// v goes to x.
[[nodiscard]] bool keeps_surfaces(const Volume &volume, std::span<const Index> star,
                                  Index v, const Vector<3> &x, double hausdorff_number);

/// Adds to the star of v, marked, the cells whose circumball in the metric of v
/// contains v, as far as they can be reached without crossing a constrained facet.
void grow_cavity(Volume &volume, Index v, std::vector<Index> &star);

/// Whether one of the edges of a cell is a ridge, which a cavity must not swallow.
[[nodiscard]] bool has_ridge(const Volume &volume, const Cell<3> &cell);

} // namespace anistar
