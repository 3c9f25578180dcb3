#pragma once
// Moves Steiner points along their lines, away from where rounding turns cells over.

#include "generate/constrained/mesh/ghost_mesh.h"
#include "generate/constrained/points/exact_points.h"

namespace anistar::generate {

class SteinerMoves {
public:
  SteinerMoves(ExactPoints &points, const GhostMesh &mesh,
               const PerCell<Index> &regions);

  /// Moves a Steiner point of a flat cell to where the worst of its cells is far
  /// better. Facets and segments stay as they are. @returns whether there is one
  bool improve(Index c);

private:
  ExactPoints &points_;
  const GhostMesh &mesh_;
  const PerCell<Index> &regions_;
  PerVertex<bool> is_end_; ///< of a line with Steiner points, which would move with it

  bool move(Index v);
  [[nodiscard]] double shortest_edge(Index v) const;
  [[nodiscard]] double least_shape(Index v) const;
};

} // namespace anistar::generate
