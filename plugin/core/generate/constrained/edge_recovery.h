#pragma once
// Makes every edge that the facets require an edge of the Delaunay mesh.

#include "base/monitor.h"
#include "generate/constrained/facet_flips.h"
#include "generate/constrained/insertion.h"
#include "generate/constrained/split_rule.h"

#include <vector>

namespace anistar::generate {

/// What is missing is divided at Steiner points, and the mesh stays Delaunay; edges
/// within facets give way to other diagonals first, if they may.
class EdgeRecovery {
public:
  struct Counts {
    std::size_t missing = 0;       ///< at the start
    std::size_t on_flat_lines = 0; ///< points placed within facets
  };

  EdgeRecovery(ExactPoints &points, GhostMesh &mesh, FacetTriangles &facets,
               FacetFlips *flips);

  /// @throws MeshingError where an edge passes through a point, or what cannot be
  /// divided any more is missing; BudgetSpent
  Counts run(Monitor &monitor);

private:
  ExactPoints &points_;
  GhostMesh &mesh_;
  FacetTriangles &facets_;
  FacetFlips *flips_; ///< null: facets keep their triangles
  SplitRule rule_;
  Insertion insertion_;
  Counts counts_;
  // stacks of edges: those of the complex are divided first, those within facets when
  // nothing else is missing and they have been looked at twice
  std::vector<Index> segments_, flat_, deferred_;

  void push(Index edge) { (facets_.is_flat(edge) ? flat_ : segments_).push_back(edge); }
  void push_missing_edges();
  [[nodiscard]] bool is_missing(Index edge) const;
  bool flip(Index edge);
  void split(Index edge);
  void push_lost_edges();
};

} // namespace anistar::generate
