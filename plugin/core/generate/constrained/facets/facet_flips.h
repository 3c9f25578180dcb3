#pragma once
// The choice of the triangles that make up a nearly planar facet: those of the input
// are often none that a Delaunay mesh has, and any others within its flatness will do.

#include "generate/constrained/facets/facet_triangles.h"
#include "generate/constrained/mesh/ghost_mesh.h"
#include "generate/constrained/points/exact_points.h"

namespace anistar::generate {

class FacetFlips {
public:
  FacetFlips(const ExactPoints &points, const GhostMesh &mesh, FacetTriangles &facets)
      : points_(points), mesh_(mesh), facets_(facets) {}

  /// Flips missing edges within facets to diagonals that the mesh has, or else towards
  /// the Delaunay triangles of the facet. @pre no planes are known yet
  void flip_missing_edges();
  /// Flips a missing edge that is required, as above.
  /// @returns the edges that are required from then on, none if it did not flip
  [[nodiscard]] std::vector<Index> flip_required(Index edge, ExactPoints &points);

  [[nodiscard]] std::size_t n_flips() const { return n_flips_; }

private:
  const ExactPoints &points_;
  const GhostMesh &mesh_;
  FacetTriangles &facets_;
  EdgeTable tries_; ///< how often each diagonal was made
  std::size_t n_flips_ = 0;

  [[nodiscard]] bool should_flip(Index edge);
};

} // namespace anistar::generate
