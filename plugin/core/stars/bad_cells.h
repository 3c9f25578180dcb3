#pragma once
// The cells that break a rule of Algorithm 2, for meshes of triangles and of
// tetrahedra.

#include "metric/background.h"
#include "stars/rules.h"

namespace anistar {

/// A bad cell, the rule that it breaks and the vertex in whose star it is bad.
template <std::size_t d> struct BadCell {
  Index cell;
  Cell<d> vertices;
  Rule rule;
  Index star;
};

/// The cells that break a rule in a star that they are in, those of the first rule
/// first. The sizing field is that of the bounded distortion (Definition 2.2).
/// @param bits see DelaunayTest
/// @param everywhere rules 1 to 3 also for cells that are consistent
template <std::size_t d>
[[nodiscard]] std::vector<BadCell<d>>
bad_cells(const Triangulation<d> &mesh, const Background<d> &background,
          const std::vector<std::uint8_t> &bits,
          const ConsistencyParameters &parameters, bool everywhere);

} // namespace anistar
