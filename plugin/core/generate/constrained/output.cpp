#include "generate/constrained/output.h"

#include "generate/constrained/regions/regions.h"

#include <algorithm>

namespace anistar::generate {
namespace {

class Output {
public:
  Output(const ExactPoints &points, const GhostMesh &mesh, const FacetTriangles &facets,
         const PerCell<Index> &regions)
      : points_(points), mesh_(mesh), facets_(facets), regions_(regions),
        facet_of_plane_(facets.facets_of_planes()) {}

  Tetrahedralisation make() {
    for (Index v = 0; v < points_.size(); ++v)
      out_.points.push_back(points_.rounded(v));
    const auto steiner = points_.steiner_points();
    out_.steiner_points.assign(steiner.begin(), steiner.end());
    for (Index c = 0; c < mesh_.n_slots(); ++c)
      if (is_inside(c)) {
        out_.cells.push_back(mesh_.cell(c));
        out_.cell_regions.push_back(regions_[c]);
        for (std::size_t i = 0; i < 4; ++i)
          add_wall({c, i});
      }
    add_edges();
    return std::move(out_);
  }

private:
  const ExactPoints &points_;
  const GhostMesh &mesh_;
  const FacetTriangles &facets_;
  const PerCell<Index> &regions_;
  std::vector<Index> facet_of_plane_;
  EdgeTable edges_of_walls_;
  Tetrahedralisation out_;

  [[nodiscard]] bool is_inside(Index c) const {
    return mesh_.is_alive(c) && regions_[c] != outside;
  }

  void add_wall(HalfFacet h) {
    const Index plane = mesh_.wall(h);
    const HalfFacet other = mesh_.opposite(h);
    if (plane == none || (is_inside(other.cell()) && other < h))
      return;
    const auto [a, b, c] = facets_.planes()[plane];
    const bool is_above =
        points_.orientation(a, b, c, mesh_.apex(h)) == Orientation::positive;
    const Facet<3> wall = mesh_.facet(is_above ? h : other);
    out_.walls.push_back(wall);
    out_.wall_facets.push_back(facet_of_plane_[plane]);
    for (std::size_t i = 0; i < 3; ++i)
      edges_of_walls_.put(wall[i], wall[(i + 1) % 3], 0);
  }

  void add_edges() {
    for (const FacetTriangles::Edge &edge : facets_.edges()) {
      if (!edge.is_alive || edge.line == none)
        continue;
      const Index segment = facets_.lines()[edge.line].segment;
      if (segment == none || !is_edge_inside(edge.from, edge.to))
        continue;
      out_.edges.push_back({edge.from, edge.to});
      out_.edge_segments.push_back(segment);
    }
  }

  [[nodiscard]] bool is_edge_inside(Index from, Index to) const {
    if (edges_of_walls_.find(from, to) != none)
      return true;
    const auto place = mesh_.find_edge(from, to);
    if (!place)
      return false;
    std::vector<HalfFacet> ring;
    mesh_.ring(*place, ring);
    return std::ranges::any_of(ring, [&](HalfFacet h) { return is_inside(h.cell()); });
  }
};

} // namespace

Tetrahedralisation output(const ExactPoints &points, const GhostMesh &mesh,
                          const FacetTriangles &facets, const PerCell<Index> &regions) {
  return Output(points, mesh, facets, regions).make();
}

} // namespace anistar::generate
