#pragma once
// Constrained Delaunay cells of a polyhedron, one after another from its border
// inwards.

#include "base/monitor.h"
#include "generate/constrained/points/exact_points.h"
#include "generate/constrained/recovery/facet_side.h"

#include <optional>
#include <span>
#include <vector>

namespace anistar::generate {

/// A polyhedron between facets and, on one side, a plane on which it may end anywhere.
struct HalfCavity {
  std::vector<Facet<3>> border; ///< the inside is on their positive side
  std::vector<Index> vertices;
  bool is_open; ///< towards the plane
};

struct Wrapping {
  std::vector<Cell<3>> cells;
  std::vector<Facet<3>> on_plane; ///< where it ends; the inside is on the positive side
  std::size_t rejections = 0;     ///< of apexes that were not visible
};

/// Gift-wrapping: each facet of the front gets the apex whose circumsphere contains no
/// other that it sees.
///
/// First without looking whether a new cell meets the front elsewhere: when the front
/// closes, the cells are right nevertheless. They are positive, and together their
/// border is that of the polyhedron, so that each point inside is covered as often as
/// the border winds round it, which is once. Else again, looking.
/// @returns nothing if the front does not close
[[nodiscard]] std::optional<Wrapping> wrapped(const ExactPoints &points,
                                              FacetSide &side, const HalfCavity &half,
                                              Monitor &monitor);

} // namespace anistar::generate
