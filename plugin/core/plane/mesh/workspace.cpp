#include "plane/mesh/workspace.h"

namespace anistar {

void renumber(Workspace &w, int threads, double shift) {
  const std::vector<Index> rank = sort_along_curve(w.mesh, threads, shift).rank;
  for (CurveEdge &edge : w.on_curves.curve_edges)
    for (Index *v : {&edge.v0, &edge.v1})
      if (*v != none) // an entry that a collapse left behind has lost its vertex
        *v = rank[*v];
}

} // namespace anistar
