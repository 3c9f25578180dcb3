#pragma once
// Where a missing edge is divided: Si, Adaptive tetrahedral mesh generation by
// constrained Delaunay refinement, 2008, section 4.

#include "generate/constrained/exact_points.h"
#include "generate/constrained/facet_triangles.h"
#include "generate/constrained/ghost_mesh.h"

namespace anistar::generate {

/// A part of a line, in its sense, between fractions of its length.
struct LinePart {
  Index line, from, to;
  double low, high;
};

class SplitRule {
public:
  SplitRule(const ExactPoints &points, const GhostMesh &mesh,
            const FacetTriangles &facets);

  [[nodiscard]] LinePart part_of(Index edge) const;
  /// The fraction of its line at which the missing part is divided.
  [[nodiscard]] double fraction(const LinePart &part) const;

private:
  const ExactPoints &points_;
  const GhostMesh &mesh_;
  const FacetTriangles &facets_;
  PerVertex<bool> is_acute_;

  [[nodiscard]] bool is_acute(Index v) const;
  [[nodiscard]] Index reference_point(const LinePart &part) const;
  void refuse_point_between(const LinePart &part, Index v) const;
  [[nodiscard]] double near_reference(const LinePart &part, Index reference) const;
  [[nodiscard]] double round_acute_end(const LinePart &part, Index reference,
                                       bool at_from) const;
};

} // namespace anistar::generate
