#pragma once
// The graph of the vertices of a mesh: edges, and the vertices across each facet.

#include <cstdint>
#include <span>
#include <vector>

namespace anistar {

/// The neighbours of v are neighbours[offsets[v]] to neighbours[offsets[v + 1]],
/// increasing, without v.
struct VertexGraph {
  std::vector<std::int32_t> offsets, neighbours;
};

/// Joins the ends of each edge of the mesh and the vertices opposite across each facet.
/// @pre `cells` holds rows of `corners` (3 or 4) vertices below `n_points`.
/// @throws std::length_error if the graph has more entries than an int32 can count.
[[nodiscard]] VertexGraph wide_graph(std::span<const std::int32_t> cells,
                                     std::size_t corners, std::size_t n_points);

} // namespace anistar
