#include "generate/plane/walls.h"

#include <algorithm>

namespace anistar::generate {
namespace {

Segment sorted(const Segment &edge) {
  return {std::min(edge[0], edge[1]), std::max(edge[0], edge[1])};
}

} // namespace

WallList walls_of(const PlaneMesh &mesh) {
  WallList out;
  for (Index c = 0; c < static_cast<Index>(mesh.cells.size()); ++c)
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfFacet h(c, i), other = mesh.opposite(h);
      if (mesh.wall(h) == none || (other.exists() && other < h))
        continue;
      out.edges.push_back(mesh.edge(h));
      out.segments.push_back(mesh.wall(h));
    }
  return out;
}

PlaneMesh walled_mesh(std::span<const Vector<2>> points, std::span<const Cell<2>> cells,
                      std::span<const Index> regions, std::span<const Segment> walls,
                      std::span<const Index> segments) {
  PlaneMesh mesh;
  mesh.points.assign(points.begin(), points.end());
  mesh.cells.assign(cells.begin(), cells.end());
  mesh.regions.assign(regions.begin(), regions.end());
  mesh.neighbours = adjacency<2>(cells, points.size());
  std::vector<std::pair<Segment, Index>> known;
  for (std::size_t w = 0; w < walls.size(); ++w)
    known.emplace_back(sorted(walls[w]), segments[w]);
  std::sort(known.begin(), known.end());
  mesh.walls.assign(cells.size(), {none, none, none});
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::pair wanted(sorted(facet_of<2>(cells[c], i)), Index{0});
      const auto found = std::lower_bound(known.begin(), known.end(), wanted);
      if (found != known.end() && found->first == wanted.first)
        mesh.walls[c][i] = found->second;
    }
  return mesh;
}

} // namespace anistar::generate
