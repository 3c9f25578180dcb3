#pragma once
// Makes every edge that the facets require an edge of the Delaunay mesh.

#include "base/monitor.h"
#include "generate/constrained/facets/facet_flips.h"
#include "generate/constrained/mesh/insertion.h"
#include "generate/constrained/recovery/split_rule.h"

#include <vector>

namespace anistar::generate {

/// Facets whose triangles stay as they are while edges are recovered.
using RigidFacets = std::vector<bool>;

/// What is missing is divided at Steiner points, and the mesh stays Delaunay; edges
/// within facets give way to other diagonals first, unless their facet is rigid.
///
/// Such a flip requires edges that were not, which spares points as a rule, but may go
/// on for ever where a facet is long and all but planar: it must be rigid.
class EdgeRecovery {
public:
  struct Counts {
    std::size_t missing = 0;       ///< at the start
    std::size_t on_flat_lines = 0; ///< points placed within facets
    std::size_t flips = 0;
  };

  EdgeRecovery(ExactPoints &points, GhostMesh &mesh, FacetTriangles &facets,
               RigidFacets &rigid);

  /// @returns false if it has stopped, since a facet got too many points: it is rigid
  /// now
  /// @throws MeshingError where an edge passes through a point, or what cannot be
  /// divided any more is missing; BudgetSpent
  [[nodiscard]] bool run(Monitor &monitor);
  [[nodiscard]] const Counts &counts() const { return counts_; }

private:
  ExactPoints &points_;
  GhostMesh &mesh_;
  FacetTriangles &facets_;
  RigidFacets &rigid_;
  std::vector<Index> may_place_; ///< how many points each facet may get yet
  FacetFlips flips_;
  SplitRule rule_;
  Insertion insertion_;
  Counts counts_;
  // stacks of edges: those of the complex are divided first, those within facets when
  // nothing else is missing and they have been looked at twice
  std::vector<Index> segments_, flat_, deferred_;

  void push(Index edge) { (facets_.is_flat(edge) ? flat_ : segments_).push_back(edge); }
  void push_missing_edges();
  [[nodiscard]] bool is_missing(Index edge) const;
  [[nodiscard]] Index facet_at(Index flat_edge) const;
  bool flip(Index edge);
  [[nodiscard]] bool is_getting_too_many(Index flat_edge);
  void split(Index edge);
  void require_end(const Line &line) const;
  void push_lost_edges();
};

} // namespace anistar::generate
