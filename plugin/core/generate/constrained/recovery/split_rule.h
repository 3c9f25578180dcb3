#pragma once
// Where a missing edge is divided.
//
// At the foot of what is in its way, which puts the new point as near to that as can
// be. Where this was put on another line from the same acute vertex, both would be
// divided in turns for ever: there the point is put on a sphere about that vertex, so
// that the parts of all its lines become equally long (Si, Adaptive tetrahedral mesh
// generation by constrained Delaunay refinement, 2008, section 4, which puts points on
// spheres about the ends of lines in the first case as well; feet spare up to half of
// the points).

#include "generate/constrained/facets/facet_triangles.h"
#include "generate/constrained/mesh/ghost_mesh.h"
#include "generate/constrained/points/exact_points.h"

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
  [[nodiscard]] bool share_acute_end(Index end, Index reference) const;
  [[nodiscard]] double foot_of(const LinePart &part, Index reference) const;
  [[nodiscard]] double round_acute_end(const LinePart &part, Index reference,
                                       bool at_from) const;
};

} // namespace anistar::generate
