#pragma once
// Triangles that need not fit together.

#include "base/tensor.h"
#include "mesh/adjacency.h"

#include <vector>

namespace anistar::generate {

struct TriangleSoup {
  std::vector<Vector<3>> points;
  std::vector<Facet<3>> triangles;
  std::vector<Index> sources; ///< of each: the triangle that it is a part of
};

} // namespace anistar::generate
