#pragma once
// What there is of a facet in the mesh, and where it passes through a cell.

#include "generate/constrained/facets/facet_triangles.h"
#include "generate/constrained/mesh/ghost_mesh.h"
#include "generate/constrained/recovery/facet_side.h"

#include <vector>

namespace anistar::generate {

/// An edge that the facet needs is not in the mesh any more: another facet crosses it.
struct LostEdge {
  Index from, to;
};

/// Walks over the plane of a facet from its required edges on, which the mesh has.
class FacetWalk {
public:
  /// @param side of the plane of the facet
  FacetWalk(const GhostMesh &mesh, const FacetTriangles &facets, FacetSide &side)
      : mesh_(mesh), facets_(facets), side_(side) {}

  /// Whether the triangles of the facet are facets of the mesh, as most are.
  [[nodiscard]] bool find_triangles(const std::vector<Index> &triangles);
  /// Finds the facets of the mesh that make up the facet, if it is complete.
  /// @returns a cell that the facet passes through, `none` if there is none
  /// @throws LostEdge
  [[nodiscard]] Index walk(const std::vector<Index> &triangles);

  /// The facets of the mesh, seen from above the plane.
  [[nodiscard]] const std::vector<HalfFacet> &found() const { return found_; }

private:
  /// An edge of the mesh in a plane, with the facet on its left, seen from above.
  struct Border {
    Index from, to;
  };

  const GhostMesh &mesh_;
  const FacetTriangles &facets_;
  FacetSide &side_;
  Visits noted_;
  std::vector<HalfFacet> found_, ring_;

  [[nodiscard]] HalfFacet find_triangle(const Facet<3> &triangle) const;
  [[nodiscard]] HalfFacet from_above(HalfFacet h, const Facet<3> &triangle) const;
  [[nodiscard]] std::vector<Border> borders(const std::vector<Index> &triangles) const;
  [[nodiscard]] HalfFacet look_left(const Border &border, Index &crossed);
};

} // namespace anistar::generate
