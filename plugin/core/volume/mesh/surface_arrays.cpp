#include "volume/mesh/surface_arrays.h"

namespace anistar {

SurfaceArrays surface_arrays(const Triangulation<3> &mesh,
                             std::span<const RidgeEdge> ridges,
                             const SurfaceShape &surface) {
  SurfaceArrays out;
  for (std::size_t k = 0; k < mesh.cells.size(); ++k) {
    const auto c = static_cast<Index>(k);
    for (std::size_t i = 0; mesh.is_alive(c) && i < 4; ++i) {
      const HalfFacet h(c, i), beyond = mesh.opposite(h);
      if (mesh.constraint(h) == none || (beyond.exists() && beyond.cell() < c))
        continue;
      const Facet<3> t = mesh.facet(h);
      out.sides.push_back(h);
      out.facets.push_back({t[0], t[2], t[1]});
      out.facet_tags.push_back(surface.patch(mesh.constraint(h)).tag);
    }
  }
  for (const RidgeEdge &edge : ridges) {
    if (edge.ends[0] == none || !surface.curve(edge.curve).is_given)
      continue;
    out.edges.push_back(edge.ends);
    out.edge_tags.push_back(surface.curve(edge.curve).tag);
  }
  return out;
}

} // namespace anistar
