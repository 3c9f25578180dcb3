#pragma once
// The facets of surfaces that break a rule of Algorithm 4, for meshes of triangles and
// of tetrahedra.

#include "certificate/surface/surface_stars.h"
#include "stars/bad_cells.h"

namespace anistar {

/// The facets of the surfaces of a mesh, and in which surface stars they are.
template <std::size_t d> struct SurfaceStars {
  std::vector<SeenFacet<d>> facets;
  std::vector<std::array<Index, d>> inside; ///< see encroaching_vertices

  [[nodiscard]] bool is_consistent(std::size_t facet) const;
  /// The part of the facets, below one, that is not in the surface stars of all its
  /// vertices.
  [[nodiscard]] double failing_fraction() const;
};

/// Of those that are not in the surface stars of all their vertices, the rules that
/// they break in a star that they are in; the first rule first.
template <std::size_t d>
[[nodiscard]] std::vector<BadCell<d>>
bad_facets(const Triangulation<d> &mesh, const Background<d> &background,
           const SurfaceStars<d> &surface, const ConsistencyParameters &parameters);

} // namespace anistar
