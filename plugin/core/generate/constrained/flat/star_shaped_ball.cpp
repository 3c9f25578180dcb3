#include "generate/constrained/flat/star_shaped_ball.h"

#include "generate/constrained/points/cell_shape.h"

#include <algorithm>

namespace anistar::generate {
namespace {

Segment sorted_edge(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// The facet of a cell, joined to a point on the side of the cell.
Cell<3> joined(const GhostMesh &mesh, HalfFacet h, Index p) {
  Cell<3> made = mesh.cell(h.cell());
  made[h.facet()] = p;
  return made;
}

} // namespace

std::optional<Swap> StarShapedBall::about(Index c, Index p, double least_shape) {
  inside_.start(mesh_.n_slots());
  inside_.visit(c);
  cells_.assign(1, c);
  if (!grow(p, least_shape))
    return std::nullopt;
  const auto facets = border();
  if (!keeps_all(facets))
    return std::nullopt;
  std::vector<Cell<3>> made;
  for (const HalfFacet h : facets)
    made.push_back(joined(mesh_, h, p));
  return checked(points_, mesh_, cells_, std::move(made));
}

bool StarShapedBall::grow(Index p, double least_shape) {
  for (bool is_seen = false; !is_seen;) {
    is_seen = true;
    for (const HalfFacet h : border()) {
      const HalfFacet across = mesh_.opposite(h);
      if (inside_.has(across.cell()) ||
          shape_of(points_, joined(mesh_, h, p)) > least_shape)
        continue;
      if (cells_.size() == most_cells || !may_take(across))
        return false;
      inside_.visit(across.cell());
      cells_.push_back(across.cell());
      is_seen = false;
    }
  }
  return true;
}

/// Whether a cell beside the ball is of the same region, and no wall is between.
bool StarShapedBall::may_take(HalfFacet across) const {
  const Index c = across.cell();
  if (regions_[c] != regions_[cells_.front()])
    return false;
  for (std::size_t i = 0; i < 4; ++i) {
    const HalfFacet h(c, i);
    if (mesh_.wall(h) != none && inside_.has(mesh_.opposite(h).cell()))
      return false;
  }
  return true;
}

std::vector<HalfFacet> StarShapedBall::border() const {
  std::vector<HalfFacet> found;
  for (const Index c : cells_)
    for (std::size_t i = 0; i < 4; ++i)
      if (!inside_.has(mesh_.opposite({c, i}).cell()))
        found.emplace_back(c, i);
  return found;
}

/// Whether the border is a closed surface with all vertices and segments of the ball.
bool StarShapedBall::keeps_all(const std::vector<HalfFacet> &border) const {
  std::vector<Segment> edges;
  std::vector<Index> vertices;
  for (const HalfFacet h : border) {
    const Facet<3> facet = mesh_.facet(h);
    for (std::size_t i = 0; i < 3; ++i) {
      edges.push_back(sorted_edge(facet[i], facet[(i + 1) % 3]));
      vertices.push_back(facet[i]);
    }
  }
  std::ranges::sort(edges);
  std::ranges::sort(vertices);
  for (std::size_t i = 0; i < edges.size(); i += 2)
    if (edges[i] != edges[i + 1] ||
        (i + 2 < edges.size() && edges[i + 1] == edges[i + 2]))
      return false;
  return std::ranges::all_of(cells_, [&](Index c) {
    const Cell<3> &cell = mesh_.cell(c);
    for (std::size_t i = 0; i < 4; ++i) {
      if (!std::ranges::binary_search(vertices, cell[i]))
        return false;
      for (std::size_t j = i + 1; j < 4; ++j)
        if (facets_.is_segment(cell[i], cell[j]) &&
            !std::ranges::binary_search(edges, sorted_edge(cell[i], cell[j])))
          return false;
    }
    return true;
  });
}

} // namespace anistar::generate
