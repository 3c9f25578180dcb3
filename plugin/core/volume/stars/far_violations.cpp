#include "volume/stars/far_violations.h"

#include <algorithm>

namespace anistar {

std::vector<SeenFacet<3>> seen_walls(const Volume &volume,
                                     const SurfaceNormals &normals) {
  const Triangulation<3> &mesh = volume.mesh;
  std::vector<SeenFacet<3>> walls;
  for (std::size_t k = 0; k < mesh.cells.size(); ++k) {
    const auto c = static_cast<Index>(k);
    for (std::size_t i = 0; mesh.is_alive(c) && volume.is_walled(c) && i < 4; ++i) {
      const HalfFacet h(c, i), beyond = mesh.opposite(h);
      if (mesh.constraint(h) == none || (beyond.exists() && beyond.cell() < c))
        continue;
      const auto star = std::get<WallStar>(deciding_star(mesh, normals, h));
      walls.push_back({h, mesh.facet(h), surface_facets(star)});
    }
  }
  return walls;
}

std::vector<WallViolation> wall_violations(const Volume &volume,
                                           const SurfaceNormals &normals, int threads,
                                           const Look &look) {
  const std::vector<SeenFacet<3>> walls = seen_walls(volume, normals);
  const auto inside =
      encroaching_vertices<3>(certified(volume.mesh), walls, threads, look);
  std::vector<WallViolation> found;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const auto first = std::find_if(inside[k].begin(), inside[k].end(),
                                    [](Index v) { return v >= 0; });
    if (first != inside[k].end())
      found.push_back({walls[k].at, *first});
  }
  return found;
}

} // namespace anistar
