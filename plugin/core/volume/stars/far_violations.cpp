#include "volume/stars/far_violations.h"

#include <algorithm>

namespace anistar {
namespace {

SeenFacet<3> seen_wall(const Triangulation<3> &mesh, const SurfaceNormals &normals,
                       HalfFacet wall) {
  const auto star = std::get<WallStar>(deciding_star(mesh, normals, wall));
  return {wall, mesh.facet(wall), surface_facets(star)};
}

} // namespace

std::vector<SeenFacet<3>> seen_walls(const Volume &volume,
                                     const SurfaceNormals &normals) {
  const Triangulation<3> &mesh = volume.mesh;
  std::vector<SeenFacet<3>> walls;
  for (std::size_t k = 0; k < mesh.cells.size(); ++k) {
    const auto c = static_cast<Index>(k);
    for (std::size_t i = 0; mesh.is_alive(c) && volume.is_walled(c) && i < 4; ++i)
      if (const HalfFacet h(c, i);
          mesh.constraint(h) != none && first_side(mesh, h) == h)
        walls.push_back(seen_wall(mesh, normals, h));
  }
  return walls;
}

std::vector<WallViolation> wall_violations(const Triangulation<3> &mesh,
                                           const SurfaceNormals &normals,
                                           std::span<const HalfFacet> walls,
                                           int threads, const Look &look) {
  std::vector<SeenFacet<3>> seen;
  for (HalfFacet wall : walls)
    seen.push_back(seen_wall(mesh, normals, wall));
  const auto inside = encroaching_vertices<3>(certified(mesh), seen, threads, look);
  std::vector<WallViolation> found;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const auto first = std::find_if(inside[k].begin(), inside[k].end(),
                                    [](Index v) { return v >= 0; });
    if (first != inside[k].end())
      found.push_back({walls[k], *first});
  }
  return found;
}

} // namespace anistar
