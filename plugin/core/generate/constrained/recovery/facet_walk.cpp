#include "generate/constrained/recovery/facet_walk.h"

#include <algorithm>

namespace anistar::generate {

bool FacetWalk::find_triangles(const std::vector<Index> &triangles) {
  found_.clear();
  for (const Index k : triangles) {
    found_.push_back(find_triangle(facets_.triangles()[k].vertices));
    if (!found_.back().exists())
      return false;
  }
  return true;
}

HalfFacet FacetWalk::find_triangle(const Facet<3> &triangle) const {
  const auto [a, b, c] = triangle;
  for (const Index cell : mesh_.star(a))
    if (mesh_.index_of(cell, b) && mesh_.index_of(cell, c)) {
      std::size_t i = 0;
      while (mesh_.cell(cell)[i] == a || mesh_.cell(cell)[i] == b ||
             mesh_.cell(cell)[i] == c)
        ++i;
      return from_above({cell, i}, triangle);
    }
  return {};
}

/// Of the two sides of a facet that which sees it in the sense of the triangle.
HalfFacet FacetWalk::from_above(HalfFacet h, const Facet<3> &triangle) const {
  const Facet<3> seen = mesh_.facet(h);
  const auto first = std::ranges::find(seen, triangle[0]) - seen.begin();
  return seen[(first + 1) % 3] == triangle[1] ? h : mesh_.opposite(h);
}

std::vector<FacetWalk::Border>
FacetWalk::borders(const std::vector<Index> &triangles) const {
  std::vector<Border> out;
  for (const Index k : triangles) {
    const FacetTriangles::Triangle &t = facets_.triangles()[k];
    for (std::size_t i = 0; i < 3; ++i)
      if (facets_.is_required(t.edges[i]))
        out.push_back({t.vertices[i], t.vertices[(i + 1) % 3]});
  }
  return out;
}

Index FacetWalk::walk(const std::vector<Index> &triangles) {
  found_.clear();
  noted_.start(4 * static_cast<std::size_t>(mesh_.n_slots()));
  std::vector<Border> ahead = borders(triangles);
  while (!ahead.empty()) {
    const Border border = ahead.back();
    ahead.pop_back();
    Index crossed = none;
    const HalfFacet h = look_left(border, crossed);
    if (crossed != none)
      return crossed;
    if (!h.exists())
      throw LostEdge{border.from, border.to};
    if (!noted_.visit(h.code()))
      continue;
    found_.push_back(h);
    const Facet<3> triangle = mesh_.facet(h);
    for (std::size_t i = 0; i < 3; ++i) {
      const Index from = triangle[i], to = triangle[(i + 1) % 3];
      const Index edge = facets_.find(from, to);
      if (from != border.from && (edge == none || !facets_.is_required(edge)))
        ahead.push_back({to, from});
    }
  }
  return none;
}

/// The facet of the mesh on the left of a border, seen from above, or the cell that the
/// facet passes through there.
HalfFacet FacetWalk::look_left(const Border &border, Index &crossed) {
  const auto place = mesh_.find_edge(border.from, border.to);
  if (!place)
    throw LostEdge{border.from, border.to};
  mesh_.ring(*place, ring_);
  for (const HalfFacet leave : ring_) {
    const Index c = leave.cell();
    // the cell is positive as (from, to, x, y)
    Index x = none, y = none;
    std::size_t y_place = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Facet<3> opposite = mesh_.facet({c, i});
      if (mesh_.cell(c)[i] == border.from || mesh_.cell(c)[i] == border.to)
        continue;
      const auto at = std::ranges::find(opposite, border.from) - opposite.begin();
      if (opposite[(at + 1) % 3] == border.to) {
        y_place = i;
        y = mesh_.cell(c)[i];
        x = opposite[(at + 2) % 3];
      }
    }
    if (x == ghost || y == ghost)
      continue;
    if (side_.is_on(x) && side_.is_above(y))
      return {c, y_place};
    if (side_.is_below(x)) {
      if (side_.is_above(y)) {
        crossed = c;
        return {};
      }
      if (side_.is_on(
              y)) { // the cell below; seen from above it is its neighbour's facet
        std::size_t x_place = *mesh_.index_of(c, x);
        return mesh_.opposite({c, x_place});
      }
    }
  }
  return {};
}

} // namespace anistar::generate
