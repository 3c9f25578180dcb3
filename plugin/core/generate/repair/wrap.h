#pragma once
// A closed surface around triangles that bound nothing.

#include "generate/repair/triangle_soup.h"

#include <span>

namespace anistar::generate {

/// Sizes of a wrap, as lengths.
struct WrapSizes {
  double alpha;  ///< of the smallest opening that it enters
  double offset; ///< of it from the triangles
};

/// Alpha wrapping (Portaneri, Rouxel-Labbe, Hemmer, Cohen-Steiner, Alliez, Alpha
/// wrapping with an offset, 2022), as CGAL has it: closed, without self-intersections,
/// outward. Its triangles have no sources.
[[nodiscard]] TriangleSoup wrapped(std::span<const Vector<3>> points,
                                   std::span<const Facet<3>> triangles,
                                   const WrapSizes &sizes);

} // namespace anistar::generate
