#pragma once
// Which triangles have to be turned round for a surface to have an outer side.

#include "base/tensor.h"
#include "mesh/adjacency.h"

#include <span>

#include <vector>

namespace anistar::generate {

struct TurnedTriangles {
  std::vector<bool> is_turned; ///< of each triangle
  std::size_t n_open;          ///< parts that bound nothing: of one sense, whichever
  std::size_t n_one_sided;     ///< parts without two sides
};

/// Triangles that share an edge with one other are turned to one sense, and parts that
/// bound a volume so that their normals point out of it; of those inside of another
/// one, which may be hollows, most triangles keep their sense.
[[nodiscard]] TurnedTriangles turned_triangles(std::span<const Vector<3>> points,
                                               std::span<const Facet<3>> triangles);

} // namespace anistar::generate
