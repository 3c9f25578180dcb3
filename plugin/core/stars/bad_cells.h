#pragma once
// The cells that break a rule of Algorithm 2, for meshes of triangles and of
// tetrahedra.

#include "metric/background.h"
#include "stars/rules.h"

namespace anistar {

/// A bad cell, the rule that it breaks and the vertex in whose star it is bad; or a bad
/// facet of a surface, with the cell behind it.
template <std::size_t d> struct BadCell {
  Index cell;
  Cell<d> vertices;
  Rule rule;
  Index star;
  HalfFacet facet{};

  [[nodiscard]] bool is_facet() const { return facet.exists(); }
};

/// The sizing field at the centre of a ball in the metric of a vertex: one, the unit of
/// the metric, or the bounded distortion radius (Definition 2.2) where that is smaller.
template <std::size_t d>
[[nodiscard]] double sizing_field(const Background<d> &background,
                                  const Vector<d> &centre, Index background_cell,
                                  double gamma_0);

/// The cells that break a rule in a star that they are in, those of the first rule
/// first.
/// @param bits see DelaunayTest
/// @param everywhere the other rules also for cells that are consistent
template <std::size_t d>
[[nodiscard]] std::vector<BadCell<d>>
bad_cells(const Triangulation<d> &mesh, const Background<d> &background,
          const std::vector<std::uint8_t> &bits,
          const ConsistencyParameters &parameters, bool everywhere);

} // namespace anistar
