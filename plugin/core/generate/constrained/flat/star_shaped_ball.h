#pragma once
// Cells about a flat one whose border is seen from a point inside.

#include "generate/constrained/facets/facet_triangles.h"
#include "generate/constrained/flat/swaps.h"

namespace anistar::generate {

class StarShapedBall {
public:
  StarShapedBall(const ExactPoints &points, const GhostMesh &mesh,
                 const FacetTriangles &facets, const PerCell<Index> &regions)
      : points_(points), mesh_(mesh), facets_(facets), regions_(regions) {}

  /// Grows from a cell, across facets from which a point makes cells of less than a
  /// shape, within one region and not across walls.
  /// @returns the cells that join the border to the point, if there is such a ball that
  /// no vertex, wall or segment gets lost in
  [[nodiscard]] std::optional<Swap> about(Index c, Index p, double least_shape);

private:
  /// Larger balls are hardly ever better.
  static constexpr std::size_t most_cells = 48;

  const ExactPoints &points_;
  const GhostMesh &mesh_;
  const FacetTriangles &facets_;
  const PerCell<Index> &regions_;
  Visits inside_;
  std::vector<Index> cells_;

  [[nodiscard]] bool grow(Index p, double least_shape);
  [[nodiscard]] bool may_take(HalfFacet across) const;
  [[nodiscard]] std::vector<HalfFacet> border() const;
  [[nodiscard]] bool keeps_all(const std::vector<HalfFacet> &border) const;
};

} // namespace anistar::generate
