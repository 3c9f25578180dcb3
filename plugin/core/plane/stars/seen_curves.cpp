#include "plane/stars/seen_curves.h"

#include "plane/geometry/facet_bulges.h"

namespace anistar {

std::vector<SeenFacet<2>> seen_curves(const Workspace &w) {
  const Triangulation<2> &mesh = w.mesh;
  std::vector<SeenFacet<2>> seen;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (std::size_t i = 0; mesh.is_alive(static_cast<Index>(c)) && i < 3; ++i) {
      const HalfFacet h(static_cast<Index>(c), i), beyond = mesh.opposite(h);
      if (mesh.constraint(h) == none || (beyond.exists() && beyond.cell() < h.cell()))
        continue;
      const CurveEdge &edge = w.curve_edge(h);
      if (edge.ball != none)
        continue;
      const Facet<2> ends = mesh.facet(h);
      const double height = chord_height(w.curve(edge), edge.t0, edge.t1);
      seen.push_back(seen_facet<2>(certified(mesh), h, ends,
                                   {ends[0] == edge.v0 ? height : -height}));
    }
  return seen;
}

} // namespace anistar
