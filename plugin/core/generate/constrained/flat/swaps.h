#pragma once
// Exchanges of a few cells for others with the same border.

#include "generate/constrained/mesh/ghost_mesh.h"
#include "generate/constrained/points/exact_points.h"

#include <span>
#include <vector>

namespace anistar::generate {

/// Cells, and those that may take their place.
struct Swap {
  std::vector<Index> old;
  std::vector<Cell<3>> cells;
  double least_before = 0, least_after = 0; ///< of their shapes
};

/// Whether the worst cell becomes better by far, and good enough.
[[nodiscard]] bool is_worth(const Swap &swap);

/// The exchange of cells for others, with their shapes, if all of those are positive.
[[nodiscard]] std::optional<Swap> checked(const ExactPoints &points,
                                          const GhostMesh &mesh, std::vector<Index> old,
                                          std::vector<Cell<3>> cells);

/// Tells which swaps there are about the cells of one region; all new cells are
/// positive.
class Swaps {
public:
  Swaps(const ExactPoints &points, const GhostMesh &mesh, const PerCell<Index> &regions)
      : points_(points), mesh_(mesh), regions_(regions) {}

  /// Removes an edge that is on no wall: the polygon of the cells round it is cut into
  /// the triangles whose two cells each have the best least shape (dynamic programming;
  /// Shewchuk, Two discrete optimization algorithms for the topological improvement of
  /// tetrahedral meshes, 2002).
  [[nodiscard]] std::optional<Swap> without_edge(Index a, Index b);
  /// Joins the apexes on both sides of a facet that is no wall.
  [[nodiscard]] std::optional<Swap> without_facet(HalfFacet h) const;
  /// The edges of the cells round the edges of a cell.
  [[nodiscard]] std::vector<Segment> edges_about(Index c);

private:
  /// More cells round an edge are hardly ever worth the search.
  static constexpr std::size_t most_round_edge = 12;

  const ExactPoints &points_;
  const GhostMesh &mesh_;
  const PerCell<Index> &regions_;
  std::vector<HalfFacet> ring_;

  [[nodiscard]] bool is_free(const std::vector<HalfFacet> &ring, Index a,
                             Index b) const;
};

} // namespace anistar::generate
