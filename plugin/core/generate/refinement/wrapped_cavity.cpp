#include "generate/refinement/wrapped_cavity.h"

#include "generate/constrained/gift_wrapping.h"
#include "generate/refinement/cavity.h"
#include "generate/refinement/spheres.h"

#include <algorithm>
#include <limits>

namespace anistar::generate {
namespace {

Facet<3> in_order(Facet<3> f) {
  std::sort(f.begin(), f.end());
  return f;
}

constexpr std::array<std::array<std::size_t, 2>, 6> edges_of_cell{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

} // namespace

bool WrappedCavity::find(const WalledMesh &mesh, const CavityBorder &border,
                         const Site &site) {
  region_ = mesh.region[border.cells.front()];
  const auto is_elsewhere = [&](Index c) { return mesh.region[c] != region_; };
  return std::none_of(border.cells.begin(), border.cells.end(), is_elsewhere) &&
         find_new_walls(mesh, border, site) && wrap(mesh, border, site) &&
         join(mesh, border) && is_delaunay(mesh, site) &&
         keeps_subsegments(mesh, border, site);
}

/// The fan of the point in each of its facets: over the edges of walls that go, but those
/// between two of them and the subsegment that is split. Facets must bound the domain.
bool WrappedCavity::find_new_walls(const WalledMesh &mesh, const CavityBorder &border,
                                   const Site &site) {
  struct Edge {
    Segment ends;
    Index facet;
    Facet<3> wall; // the point in place of the third vertex, turned as the wall
    auto operator<=>(const Edge &) const = default;
  };
  const auto point = static_cast<Index>(mesh.points.size());
  std::vector<Edge> edges;
  for (HalfFacet h : border.opened) {
    if (mesh.opposite(h).exists())
      return false;
    const Facet<3> f = mesh.facet(h);
    for (std::size_t k = 0; k < 3; ++k) {
      Facet<3> wall = f;
      wall[k] = point;
      const Index a = f[(k + 1) % 3], b = f[(k + 2) % 3];
      edges.push_back({{std::min(a, b), std::max(a, b)}, mesh.wall(h), wall});
    }
  }
  std::sort(edges.begin(), edges.end());
  new_walls_.clear();
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const auto is_twin = [&](std::size_t other) {
      return other < edges.size() && edges[other].ends == edges[k].ends &&
             edges[other].facet == edges[k].facet;
    };
    if (edges[k].ends != site.split_edge && !is_twin(k + 1) && !(k > 0 && is_twin(k - 1)))
      new_walls_.push_back({edges[k].wall, edges[k].facet});
  }
  return true;
}

bool WrappedCavity::wrap(const WalledMesh &mesh, const CavityBorder &border,
                         const Site &site) {
  std::vector<Index> vertices;
  for (Index c : border.cells)
    vertices.insert(vertices.end(), mesh.cells[c].begin(), mesh.cells[c].end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::vector<Vector<3>> places;
  for (Index v : vertices)
    places.push_back(mesh.points[v]);
  vertices.push_back(static_cast<Index>(mesh.points.size()));
  places.push_back(site.x);
  const auto local = [&](const Facet<3> &f) {
    Facet<3> out;
    for (std::size_t k = 0; k < 3; ++k)
      out[k] = static_cast<Index>(
          std::lower_bound(vertices.begin(), vertices.end(), f[k]) - vertices.begin());
    return out;
  };
  HalfCavity cavity{{}, {}, false};
  for (HalfFacet h : border.staying)
    cavity.border.push_back(local(mesh.facet(h)));
  for (const Wall &wall : new_walls_)
    cavity.border.push_back(local(wall.vertices));
  for (std::size_t k = 0; k < vertices.size(); ++k)
    cavity.vertices.push_back(static_cast<Index>(k));
  const ExactPoints points(places);
  FacetSide side(points);
  Monitor unbounded({}, std::numeric_limits<std::size_t>::max(),
                    std::numeric_limits<double>::infinity());
  const std::optional<Wrapping> wrapping = wrapped(points, side, cavity, unbounded);
  if (!wrapping)
    return false;
  cells_.clear();
  for (const Cell<3> &cell : wrapping->cells)
    cells_.push_back(
        {vertices[cell[0]], vertices[cell[1]], vertices[cell[2]], vertices[cell[3]]});
  return true;
}

/// Which facet of a new cell meets which: another, the border, or the outside at a wall.
bool WrappedCavity::join(const WalledMesh &mesh, const CavityBorder &border) {
  std::vector<CellFacet> sides;
  for (std::size_t c = 0; c < cells_.size(); ++c)
    for (std::size_t i = 0; i < 4; ++i)
      sides.push_back({in_order(facet_of<3>(cells_[c], i)), static_cast<Index>(c), i});
  std::stable_sort(sides.begin(), sides.end(), [](const CellFacet &a, const CellFacet &b) {
    return a.vertices < b.vertices;
  });
  std::vector<Stay> stays;
  for (HalfFacet h : border.staying)
    stays.push_back({in_order(mesh.facet(h)), mesh.opposite(h), mesh.wall(h)});
  for (const Wall &wall : new_walls_)
    stays.push_back({in_order(wall.vertices), HalfFacet(), wall.facet});
  std::stable_sort(stays.begin(), stays.end(), [](const Stay &a, const Stay &b) {
    return a.vertices < b.vertices;
  });
  joints_.clear();
  std::size_t n_staying = 0;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const CellFacet &side = sides[k];
    if (k + 1 < sides.size() && sides[k + 1].vertices == side.vertices) {
      joints_.push_back(
          {side.cell, side.facet, {}, sides[k + 1].cell, sides[k + 1].facet, none});
      ++k;
      continue;
    }
    const auto stay = std::lower_bound(
        stays.begin(), stays.end(), side.vertices,
        [](const Stay &s, const Facet<3> &vertices) { return s.vertices < vertices; });
    if (stay == stays.end() || stay->vertices != side.vertices)
      return false;
    joints_.push_back({side.cell, side.facet, stay->outer, none, 0, stay->wall});
    ++n_staying;
  }
  return n_staying == stays.size();
}

bool WrappedCavity::is_delaunay(const WalledMesh &mesh, const Site &site) const {
  const auto place = [&](Index v) -> const Vector<3> & {
    return std::cmp_less(v, mesh.points.size()) ? mesh.points[v] : site.x;
  };
  const auto simplex = [&](Index c) -> Simplex<3> {
    const Cell<3> &v = cells_[c];
    return {place(v[0]), place(v[1]), place(v[2]), place(v[3])};
  };
  for (std::size_t c = 0; c < cells_.size(); ++c)
    if (!has_volume<3>(simplex(static_cast<Index>(c))))
      return false;
  return std::all_of(joints_.begin(), joints_.end(), [&](const Joint &joint) {
    if (joint.wall != none)
      return true;
    const Index across = joint.other_cell != none
                             ? cells_[joint.other_cell][joint.other_facet]
                             : mesh.apex(joint.outer);
    return in_sphere(simplex(joint.cell), place(across)) != Side::inside;
  });
}

bool WrappedCavity::keeps_subsegments(const WalledMesh &mesh,
                                      const CavityBorder &border,
                                      const Site &site) const {
  const auto edges_in = [&](const Cell<3> &cell, std::vector<Segment> &out) {
    for (const auto &[i, j] : edges_of_cell)
      out.push_back({std::min(cell[i], cell[j]), std::max(cell[i], cell[j])});
  };
  std::vector<Segment> before, after;
  for (Index c : border.cells)
    edges_in(mesh.cells[c], before);
  for (const Cell<3> &cell : cells_)
    edges_in(cell, after);
  std::sort(after.begin(), after.end());
  const auto is_kept = [&](const Segment &e) {
    return std::binary_search(after.begin(), after.end(), e);
  };
  const auto point = static_cast<Index>(mesh.points.size());
  if (site.split_edge[0] != none)
    for (Index end : site.split_edge)
      if (!is_kept({end, point}))
        return false;
  return std::all_of(before.begin(), before.end(), [&](const Segment &e) {
    return e == site.split_edge || mesh.segment_of(e[0], e[1]) == none || is_kept(e);
  });
}

void WrappedCavity::put(WalledMesh &mesh, std::vector<Index> &new_cells) const {
  new_cells.clear();
  for (const Cell<3> &cell : cells_)
    new_cells.push_back(mesh.add_cell(cell, region_));
  for (const Joint &joint : joints_) {
    const HalfFacet h(new_cells[joint.cell], joint.facet);
    mesh.walls[h.cell()][h.facet()] = joint.wall;
    mesh.join(h, joint.other_cell != none
                     ? HalfFacet(new_cells[joint.other_cell], joint.other_facet)
                     : joint.outer);
  }
}

} // namespace anistar::generate
