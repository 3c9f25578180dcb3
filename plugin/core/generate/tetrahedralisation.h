#pragma once
// What the generator makes, before it is an ordinary mesh.

#include "generate/plc.h"

namespace anistar::generate {

/// A point that the generator has placed on a segment, on an edge inside a facet, or in
/// the volume, at (1 - t) a + t b; a and b may be such points themselves.
struct SteinerPoint {
  Index a, b;
  double t;
};

/// Tetrahedra that conform to a complex: its facets are unions of walls, its segments
/// of edges. Points of the complex come first and are as they were.
struct Tetrahedralisation {
  std::vector<Vector<3>> points;
  std::vector<Cell<3>> cells;      ///< positively oriented
  std::vector<Index> cell_regions; ///< of each cell, a number or the tag of a seed
  std::vector<Facet<3>> walls;
  std::vector<Index>
      wall_facets; ///< the facet of the complex that each wall is part of
  std::vector<Segment> edges;
  std::vector<Index> edge_segments; ///< the segment that each edge is part of
  std::vector<SteinerPoint>
      steiner_points; ///< of the points after those of the complex
};

} // namespace anistar::generate
