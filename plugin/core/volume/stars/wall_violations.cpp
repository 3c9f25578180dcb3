#include "volume/stars/wall_violations.h"

#include "base/parallel.h"
#include "certificate/delaunay_test.h"

#include <cmath>

namespace anistar {
namespace {

/// What a thread takes at once: some milliseconds.
constexpr std::size_t walls_at_once = 128;

/// Each from its first cell.
std::vector<HalfFacet> walls_of(const Volume &volume) {
  const Triangulation<3> &mesh = volume.mesh;
  std::vector<HalfFacet> walls;
  for (std::size_t k = 0; k < mesh.cells.size(); ++k) {
    const auto c = static_cast<Index>(k);
    for (std::size_t i = 0; mesh.is_alive(c) && volume.is_walled(c) && i < 4; ++i) {
      const HalfFacet h(c, i), beyond = mesh.opposite(h);
      if (mesh.constraint(h) != none && (!beyond.exists() || beyond.cell() > c))
        walls.push_back(h);
    }
  }
  return walls;
}

/// A vertex inside of one of its balls.
Index violator(DelaunayTest<3> &test, const WallStar &star, HalfFacet wall) {
  const std::array<SurfaceFacet<3>, 3> seen = surface_facets(star);
  for (std::size_t k = 0; k < 3; ++k)
    if (std::isfinite(seen[k].shift))
      if (const Index v = test.violator(wall, star.corners[k]->M, seen[k]); v != none)
        return v;
  return none;
}

} // namespace

std::vector<WallViolation> wall_violations(const Volume &volume,
                                           const SurfaceNormals &normals, int threads,
                                           const Look &look) {
  const Triangulation<3> &mesh = volume.mesh;
  const std::vector<HalfFacet> walls = walls_of(volume);
  const std::size_t n_parts = (walls.size() + walls_at_once - 1) / walls_at_once;
  std::vector<Index> inside(walls.size(), none);
  StopSignal stop;
  parallel_items(n_parts, threads, [&] {
    return [&, test = DelaunayTest<3>(certified(mesh))](std::size_t part) mutable {
      if (!stop.goes_on([&] {
            return look(static_cast<double>(part) / static_cast<double>(n_parts));
          }))
        return;
      const std::size_t begin = part * walls_at_once;
      for (std::size_t k = begin; k < std::min(walls.size(), begin + walls_at_once);
           ++k)
        inside[k] = violator(
            test, std::get<WallStar>(deciding_star(mesh, normals, walls[k])), walls[k]);
    };
  });
  std::vector<WallViolation> found;
  for (std::size_t k = 0; k < walls.size(); ++k)
    if (inside[k] != none)
      found.push_back({walls[k], inside[k]});
  return found;
}

} // namespace anistar
