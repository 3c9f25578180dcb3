#include "volume/pure/initial_sites.h"

#include "mesh/disjoint_sets.h"

#include <algorithm>
#include <map>

namespace anistar {
namespace {

/// Enough for a polyhedron that resembles a ball.
constexpr std::size_t sites_of_surface = 24;

bool has_ridge(const Volume &start, Index v) {
  bool found = false;
  start.ridges.around(v, [&](Index, Index) { found = true; });
  return found;
}

Site site_at(const Volume &start, Index v) {
  return {.vertex = start.mesh.vertex(v),
          .dimension = start.feature(v),
          .lies_on = start.feature(v) == 2 ? start.support_of(v) : none,
          .background = start.mesh.background_cell[v]};
}

/// The vertices of every connected surface, without those that have a ridge.
std::vector<std::vector<Index>> closed_surfaces(const Volume &start) {
  const Triangulation<3> &mesh = start.mesh;
  DisjointSets sets(mesh.vertices.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(static_cast<Index>(c), i);
      if (mesh.constraint(h) == none)
        continue;
      const Facet<3> t = mesh.facet(h);
      sets.join(t[0], t[1]);
      sets.join(t[0], t[2]);
    }
  std::map<Index, std::vector<Index>> vertices;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (mesh.is_used(static_cast<Index>(v)) &&
        mesh.feature[v] < Triangulation<3>::interior)
      vertices[static_cast<Index>(sets.root(v))].push_back(static_cast<Index>(v));
  std::vector<std::vector<Index>> found;
  for (auto &[root, of_surface] : vertices)
    if (std::none_of(of_surface.begin(), of_surface.end(),
                     [&](Index v) { return has_ridge(start, v); }))
      found.push_back(std::move(of_surface));
  return found;
}

/// Each one the farthest from those before it.
std::vector<Index> far_apart(const Volume &start, const std::vector<Index> &vertices) {
  std::vector<Index> chosen{vertices.front()};
  std::vector<double> distance(vertices.size(),
                               std::numeric_limits<double>::infinity());
  while (chosen.size() < std::min(sites_of_surface, vertices.size())) {
    const Vector<3> &last = start.mesh.vertex(chosen.back()).x;
    for (std::size_t k = 0; k < vertices.size(); ++k)
      distance[k] = std::min(distance[k],
                             (start.mesh.vertex(vertices[k]).x - last).squaredNorm());
    const auto farthest = std::max_element(distance.begin(), distance.end());
    chosen.push_back(vertices[static_cast<std::size_t>(farthest - distance.begin())]);
  }
  return chosen;
}

} // namespace

std::vector<Site> surface_sites(const Volume &start) {
  std::vector<Site> sites;
  for (Index v = 0; std::cmp_less(v, start.mesh.vertices.size()); ++v)
    if (start.mesh.is_used(v) && start.feature(v) == Triangulation<3>::corner &&
        !has_ridge(start, v))
      sites.push_back(site_at(start, v));
  for (const std::vector<Index> &surface : closed_surfaces(start))
    for (Index v : far_apart(start, surface))
      if (start.feature(v) != Triangulation<3>::corner)
        sites.push_back(site_at(start, v));
  return sites;
}

} // namespace anistar
