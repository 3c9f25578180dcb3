#pragma once
// Steiner points in the volume, in the middle of cells that take the place of a flat
// one.

#include "generate/constrained/flat/star_shaped_ball.h"

namespace anistar::generate {

class VolumePoints {
public:
  VolumePoints(ExactPoints &points, GhostMesh &mesh, const FacetTriangles &facets,
               const PerCell<Index> &regions)
      : points_(points), mesh_(mesh), ball_(points, mesh, facets, regions) {}

  /// Places a point between the middle of an edge of a flat cell and a vertex near by
  /// such that cells at it may replace the flat one. The middle is a Steiner point too,
  /// of no cell: it tells where the other one is.
  /// @returns the cells, nothing if no place is good: no point is placed then
  [[nodiscard]] std::optional<Swap> star_in_place_of(Index c);

private:
  /// Where a Steiner point may be: on the way from the middle of an edge to a vertex.
  struct Place {
    Index from, to, towards;
    double t;
  };
  ExactPoints &points_;
  GhostMesh &mesh_;
  StarShapedBall ball_;

  [[nodiscard]] std::vector<Index> vertices_beside(Index c) const;
  [[nodiscard]] std::optional<Place> best_place(Index c, double least_shape);
  Index put(const Place &place);
  void withdraw();
};

} // namespace anistar::generate
