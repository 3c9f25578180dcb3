#include "generate/constrained/mesh/ghost_mesh.h"

#include <algorithm>

namespace anistar::generate {

std::array<Index, 3> sorted(std::array<Index, 3> vertices) {
  std::ranges::sort(vertices);
  return vertices;
}

std::optional<std::size_t> GhostMesh::index_of(Index c, Index vertex) const {
  const Cell<3> &vertices = cell(c);
  for (std::size_t i = 0; i < 4; ++i)
    if (vertices[i] == vertex)
      return i;
  return std::nullopt;
}

Index GhostMesh::add(const Cell<3> &vertices) {
  Index c;
  if (free_.empty()) {
    c = n_slots();
    cells_.emplace_back();
  } else {
    c = free_.back();
    free_.pop_back();
  }
  cells_[c] = {vertices, {}, {none, none, none, none}, true};
  for (const Index v : vertices)
    if (v != ghost)
      vertex_cell_[v] = c;
  return c;
}

void GhostMesh::remove(Index c) {
  cells_[c].is_alive = false;
  free_.push_back(c);
}

void GhostMesh::join(HalfFacet one, HalfFacet other) {
  cells_[one.cell()].neighbours[one.facet()] = other;
  cells_[other.cell()].neighbours[other.facet()] = one;
}

void GhostMesh::set_wall(HalfFacet h, Index wall) {
  cells_[h.cell()].walls[h.facet()] = wall;
  const HalfFacet other = opposite(h);
  cells_[other.cell()].walls[other.facet()] = wall;
}

bool GhostMesh::join(std::vector<OpenFacet> &open) {
  std::ranges::sort(open, {}, [](const OpenFacet &f) {
    return std::pair(f.vertices, f.side.code());
  });
  // a wall between two new cells is told by itself, without a side
  std::size_t i = 0;
  while (i < open.size()) {
    std::array<HalfFacet, 2> sides;
    std::size_t n_sides = 0;
    Index wall = none;
    const auto vertices = open[i].vertices;
    for (; i < open.size() && open[i].vertices == vertices; ++i) {
      wall = std::max(wall, open[i].wall);
      if (!open[i].side.exists())
        continue;
      if (n_sides == sides.size())
        return false;
      sides[n_sides++] = open[i].side;
    }
    if (n_sides != sides.size())
      return false;
    join(sides[0], sides[1]);
    set_wall(sides[0], wall);
  }
  return true;
}

std::optional<std::vector<Index>> GhostMesh::replace(std::span<const Index> old,
                                                     std::span<const Cell<3>> cells) {
  visits_.start(cells_.size());
  for (const Index c : old)
    visits_.visit(c);
  std::vector<OpenFacet> open;
  for (const Index c : old)
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(c, i), other = opposite(h);
      if (!visits_.has(other.cell()))
        open.push_back({sorted(facet(h)), other, wall(h)});
      else if (wall(h) != none) // what is told of both sides is told twice
        open.push_back({sorted(facet(h)), HalfFacet(), wall(h)});
    }
  for (const Index c : old)
    remove(c);
  std::vector<Index> made;
  for (const Cell<3> &cell : cells) {
    made.push_back(add(cell));
    for (std::size_t i = 0; i < 4; ++i)
      open.push_back(open_facet({made.back(), i}, none));
  }
  if (!join(open))
    return std::nullopt;
  return made;
}

const std::vector<Index> &GhostMesh::star(Index vertex) const {
  visits_.start(cells_.size());
  star_.assign(1, vertex_cell_[vertex]);
  visits_.visit(star_[0]);
  for (std::size_t k = 0; k < star_.size(); ++k)
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(star_[k], i);
      if (apex(h) == vertex)
        continue;
      const Index next = opposite(h).cell();
      if (visits_.visit(next))
        star_.push_back(next);
    }
  return star_;
}

std::optional<EdgePlace> GhostMesh::find_edge(Index from, Index to) const {
  for (const Index c : star(from))
    if (index_of(c, to))
      return EdgePlace{from, to, c};
  return std::nullopt;
}

void GhostMesh::ring(const EdgePlace &edge, std::vector<HalfFacet> &cells) const {
  cells.clear();
  Index c = edge.cell;
  std::size_t enter = 0; // the vertex to be left behind
  while (cell(c)[enter] == edge.from || cell(c)[enter] == edge.to)
    ++enter;
  const auto n = n_cells();
  do {
    const HalfFacet leave(c, enter);
    cells.push_back(leave);
    const HalfFacet entered = opposite(leave);
    // the next facet to cross is opposite the vertex that both cells share
    const Cell<3> &now = cell(entered.cell());
    const Index stays = apex(entered);
    enter = 0;
    while (now[enter] == edge.from || now[enter] == edge.to || now[enter] == stays)
      ++enter;
    c = entered.cell();
  } while (c != edge.cell && cells.size() <= n);
}

} // namespace anistar::generate
