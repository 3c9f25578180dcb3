#pragma once
// What the generator meshes: a piecewise linear complex in space.

#include "base/tensor.h"
#include "mesh/adjacency.h"

#include <array>
#include <span>
#include <vector>

namespace anistar::generate {

using Segment = std::array<Index, 2>;

/// A piecewise linear complex whose facets are triangulated. Triangles of one facet lie
/// on one plane up to the flatness that the caller has accepted; which triangles make
/// it up may change, its segments may not.
struct Plc {
  std::vector<Vector<3>> points;
  std::vector<Facet<3>> triangles;
  std::vector<Index> triangle_facets; ///< of each triangle
  /// Must be unions of edges of the mesh: borders between facets, and what is embedded.
  std::vector<Segment> segments;
};

/// Which points belong to a facet, to a segment, or are to be kept anyway.
[[nodiscard]] inline std::vector<bool> used_points(const Plc &plc,
                                                   std::span<const Index> points_kept) {
  std::vector<bool> is_used(plc.points.size(), false);
  const auto use = [&](const auto &simplices) {
    for (const auto &simplex : simplices)
      for (const Index v : simplex)
        is_used[v] = true;
  };
  use(plc.triangles);
  use(plc.segments);
  for (const Index v : points_kept)
    is_used[v] = true;
  return is_used;
}

} // namespace anistar::generate
