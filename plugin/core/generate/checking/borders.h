#pragma once
// Where a surface ends, and where more than two triangles meet.

#include "generate/checking/piece.h"
#include "generate/plc.h"

#include <vector>

namespace anistar::generate {

/// A chain of edges that one triangle only has, or each an edge with many.
struct Border {
  std::vector<Index> points; ///< the first one again at the end of a closed one
  double length;
  /// Whether nothing can be inside of the surface that ends here: it and all it is
  /// connected to, and it is not in a box around something closed either.
  bool is_of_open_surface;
};

struct CrowdedEdge {
  Segment ends;
  std::size_t n_triangles;
};

struct Borders {
  std::vector<Border> borders;
  std::vector<CrowdedEdge> crowded; ///< edges of more than two triangles
};

/// What remains of a surface when triangles with an edge of their own are taken away as
/// long as there are any is closed, or nothing.
[[nodiscard]] Borders borders_of(std::span<const Vector<3>> points,
                                 std::span<const Piece> triangles);

} // namespace anistar::generate
