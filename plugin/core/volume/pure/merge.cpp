#include "volume/pure/merge.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

namespace anistar {
namespace {

using Key = std::array<Index, 3>;

Key key_of(Facet<3> t) {
  std::sort(t.begin(), t.end());
  return t;
}

void add_vertices(const StarSet &stars, Triangulation<3> &mesh) {
  for (std::size_t v = 0; v < stars.size(); ++v) {
    const Site &site = stars.site(static_cast<Index>(v));
    (void)mesh.add_vertex(site.vertex, site.dimension, site.background);
  }
}

/// Every cell from the star of its first site, where its corners are in order.
void add_cells(const StarSet &stars, Triangulation<3> &mesh) {
  for (Index v = 0; std::cmp_less(v, stars.size()); ++v)
    stars.each_cell(v, [&](const LinkTriangle &t, const StarSimplex &others) {
      if (others[0] < v)
        return;
      const Star &star = stars.star(v);
      const Index c = mesh.add_cell();
      mesh.at(c) = {v, star.site(t, 0), star.site(t, 1), star.site(t, 2)};
      mesh.region[c] = t.region;
      mesh.constraints[c] = {none, none, none, none};
      for (Index corner : mesh.at(c))
        mesh.vertex_cell[corner] = c;
    });
}

/// Whether no two cells at a facet lie on the same side of it, nor is a cell flat.
bool are_apart(Triangulation<3> &mesh) {
  try {
    mesh.neighbours = adjacency<3>(mesh.cells, mesh.vertices.size());
  } catch (const std::invalid_argument &) {
    return false;
  }
  for (std::size_t k = 0; k < mesh.cells.size(); ++k) {
    const auto c = static_cast<Index>(k);
    if (orientation<3>(mesh.simplex(c)) != Orientation::positive)
      return false;
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(c, i), beyond = mesh.opposite(h);
      if (!beyond.exists())
        continue;
      const Facet<3> t = mesh.facet(h);
      if (orientation(mesh.vertex(t[0]).x, mesh.vertex(t[1]).x, mesh.vertex(t[2]).x,
                      mesh.vertex(mesh.apex(beyond)).x) != Orientation::negative)
        return false;
    }
  }
  return true;
}

/// The patches of the surface facets.
std::map<Key, Index> surface_facets(const StarSet &stars) {
  std::map<Key, Index> patches;
  for (Index v = 0; std::cmp_less(v, stars.size()); ++v)
    stars.each_facet(v, [&](Index a, Index b, const SurfaceBall &ball) {
      patches.emplace(key_of({v, a, b}), stars.domain().facet(ball.facet).patch);
    });
  return patches;
}

/// Makes walls of the surface facets. Finds bare and loose facets.
void put_walls(const StarSet &stars, MergedMesh &out) {
  Triangulation<3> &mesh = out.mesh;
  const std::map<Key, Index> patches = surface_facets(stars);
  std::set<Key> met;
  const auto find = [&](MergeObstacle obstacle, const Key &facet) {
    out.obstacle = obstacle;
    out.defects.insert(out.defects.end(), facet.begin(), facet.end());
  };
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(static_cast<Index>(c), i), beyond = mesh.opposite(h);
      const Key key = key_of(mesh.facet(h));
      const auto found = patches.find(key);
      if (found != patches.end()) {
        mesh.set_constraint(h, found->second);
        met.insert(key);
      } else if (!beyond.exists() || mesh.region[beyond.cell()] != mesh.region[c]) {
        find(MergeObstacle::bare_facet, key);
      }
    }
  for (const auto &[key, patch] : patches)
    if (!met.contains(key))
      find(MergeObstacle::loose_facet, key);
}

void find_unused(MergedMesh &out) {
  for (std::size_t v = 0; v < out.mesh.vertices.size(); ++v)
    if (out.mesh.vertex_cell[v] == none) {
      out.obstacle = MergeObstacle::unused_site;
      out.defects.push_back(static_cast<Index>(v));
    }
}

bool has_edges(const Triangulation<3> &mesh, const std::vector<RidgeEdge> &ridges) {
  const auto edges = edges_of<3>(mesh.cells, mesh.vertices.size());
  const std::set<std::array<Index, 2>> all(edges.begin(), edges.end());
  return std::all_of(ridges.begin(), ridges.end(), [&](const RidgeEdge &ridge) {
    const auto [a, b] = ridge.ends;
    return all.contains({std::min(a, b), std::max(a, b)});
  });
}

} // namespace

MergedMesh merge(const StarSet &stars, std::vector<RidgeEdge> ridges) {
  MergedMesh out;
  out.ridges = std::move(ridges);
  Triangulation<3> &mesh = out.mesh;
  add_vertices(stars, mesh);
  add_cells(stars, mesh);
  find_unused(out);
  if (!are_apart(mesh))
    out.obstacle = MergeObstacle::overlapping_cells;
  else
    put_walls(stars, out);
  if (out.obstacle == MergeObstacle::nothing && !has_edges(mesh, out.ridges))
    out.obstacle = MergeObstacle::lost_ridge;
  if (out.obstacle != MergeObstacle::nothing)
    return out;
  const Renumbering moved = sort_along_curve<3>(mesh);
  for (RidgeEdge &ridge : out.ridges)
    for (Index &end : ridge.ends)
      end = moved.rank[end];
  return out;
}

} // namespace anistar
