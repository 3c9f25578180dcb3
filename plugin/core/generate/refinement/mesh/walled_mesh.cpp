#include "generate/refinement/mesh/walled_mesh.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace anistar::generate {

WalledMesh::WalledMesh(const Tetrahedralisation &input)
    : points(input.points), cells(input.cells), region(input.cell_regions),
      n_initial_points(input.points.size()) {
  const std::size_t n = points.size(), m = cells.size();
  neighbours = adjacency<3>(cells, n);
  constexpr std::array<Index, 4> free_of_walls{none, none, none, none};
  walls.assign(m, free_of_walls);
  visited_.assign(m, 0);
  birth.resize(m);
  for (std::uint32_t &b : birth)
    b = births_++;
  vertex_cell.assign(n, none);
  for (std::size_t c = 0; c < m; ++c)
    for (Index v : cells[c])
      vertex_cell[v] = static_cast<Index>(c);
  many_cones_.assign(n, 0);
  put_walls(input);
  for (std::size_t e = 0; e < input.edges.size(); ++e) {
    const Index segment = input.edge_segments[e];
    initial_edges.push_back({input.edges[e], segment});
    subsegments_.emplace(key(input.edges[e][0], input.edges[e][1]), segment);
    n_segments = std::max(n_segments, static_cast<std::size_t>(segment) + 1);
  }
  find_carriers();
  find_many_cones();
  find_insertion_radii();
}

void WalledMesh::put_walls(const Tetrahedralisation &input) {
  struct Side {
    Facet<3> vertices; // sorted
    HalfFacet h;
    auto operator<=>(const Side &) const = default;
  };
  const auto sorted = [](Facet<3> f) {
    std::sort(f.begin(), f.end());
    return f;
  };
  std::vector<std::uint8_t> is_at_wall(points.size(), 0);
  for (const Facet<3> &w : input.walls)
    for (Index v : w)
      is_at_wall[v] = 1;
  std::vector<Side> sides;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(static_cast<Index>(c), i);
      const Facet<3> f = facet(h);
      if (std::all_of(f.begin(), f.end(), [&](Index v) { return is_at_wall[v]; }))
        sides.push_back({sorted(f), h});
    }
  std::sort(sides.begin(), sides.end());
  for (std::size_t w = 0; w < input.walls.size(); ++w) {
    const Facet<3> f = sorted(input.walls[w]);
    auto side = std::lower_bound(sides.begin(), sides.end(), Side{f, HalfFacet()});
    if (side == sides.end() || side->vertices != f)
      continue; // it bounds no region
    for (; side != sides.end() && side->vertices == f; ++side)
      walls[side->h.cell()][side->h.facet()] = input.wall_facets[w];
    n_facets = std::max(n_facets, static_cast<std::size_t>(input.wall_facets[w]) + 1);
  }
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t i = 0; i < 4; ++i)
      if (!neighbours[c][i].exists() && walls[c][i] == none)
        throw std::invalid_argument("the boundary of cell " + std::to_string(c) +
                                    " has no wall");
}

void WalledMesh::find_carriers() {
  struct Edges {
    Index n = 0, segment = none;
    bool of_one = true;
  };
  PerVertex<Edges> edges(points.size());
  for (const auto &[edge, segment] : initial_edges)
    for (Index v : edge) {
      Edges &of = edges[v];
      of.of_one = of.of_one && (of.n == 0 || of.segment == segment);
      of.segment = segment;
      ++of.n;
    }
  carriers.resize(points.size());
  for (std::size_t v = 0; v < points.size(); ++v)
    carriers[v] = {Carrier::Kind::vertex, static_cast<Index>(v)};
  // what is between the two halves of a segment is on it; all else counts as given
  for (std::size_t v = 0; v < points.size(); ++v)
    if (edges[v].n == 2 && edges[v].of_one)
      carriers[v] = {Carrier::Kind::segment, edges[v].segment};
}

void WalledMesh::find_many_cones() {
  PerVertex<std::size_t> n_cells_at(points.size(), 0);
  for (const Cell<3> &cell : cells)
    for (Index v : cell)
      ++n_cells_at[v];
  std::vector<Index> star;
  for (std::size_t v = 0; v < points.size(); ++v) {
    walk_star(static_cast<Index>(v), star);
    if (star.size() < n_cells_at[v]) {
      many_cones_[v] = 1;
      listed_stars_.emplace(static_cast<Index>(v), std::vector<Index>());
    }
  }
  if (listed_stars_.empty())
    return;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (Index v : cells[c])
      if (many_cones_[v])
        listed_stars_[v].push_back(static_cast<Index>(c));
}

void WalledMesh::find_insertion_radii() {
  insertion_radius.assign(points.size(), std::numeric_limits<double>::infinity());
  for (const Cell<3> &cell : cells)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) {
        const double l = (points[cell[i]] - points[cell[j]]).norm();
        for (Index v : {cell[i], cell[j]})
          insertion_radius[v] = std::min(insertion_radius[v], l);
      }
}

HalfFacet WalledMesh::half_facet(Index c, const Facet<3> &vertices) const {
  if (c < 0 || !is_alive(c))
    return {};
  std::size_t apex_index = 4, n_shared = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Index v = cells[c][i];
    if (v == vertices[0] || v == vertices[1] || v == vertices[2])
      ++n_shared;
    else
      apex_index = i;
  }
  return n_shared == 3 ? HalfFacet(c, apex_index) : HalfFacet();
}

Index WalledMesh::third_vertex(HalfFacet h, Index x, Index y) const {
  const Facet<3> f = facet(h);
  return f[0] != x && f[0] != y ? f[0] : f[1] != x && f[1] != y ? f[1] : f[2];
}

HalfFacet WalledMesh::next_wall(const WallEdge &edge) const {
  // the cell has two facets at the edge: the one we come from, opposite `away`, and the
  // one that we go through, opposite `ahead`
  Index c = edge.wall.cell();
  Index away = apex(edge.wall), ahead = facet(edge.wall)[edge.k];
  for (std::size_t turn = 0; turn < cells.size(); ++turn) {
    const HalfFacet through(c, local_index(c, ahead));
    if (wall(through) != none)
      return through;
    const HalfFacet beyond = opposite(through);
    if (!beyond.exists())
      return {};
    ahead = away;
    away = apex(beyond);
    c = beyond.cell();
  }
  return {};
}

void WalledMesh::split_subsegment(const Segment &edge, Index middle) {
  const auto found = subsegments_.find(key(edge[0], edge[1]));
  const Index segment = found->second;
  subsegments_.erase(found);
  for (Index end : edge)
    subsegments_.emplace(key(end, middle), segment);
  // a fan of its own around the edge is a cone of its own at the new vertex
  if (many_cones_[edge[0]] && many_cones_[edge[1]]) {
    many_cones_[middle] = 1;
    listed_stars_.emplace(middle, std::vector<Index>());
  }
}

std::vector<WalledMesh::InitialEdge> WalledMesh::sorted_subsegments() const {
  std::vector<InitialEdge> out;
  out.reserve(subsegments_.size());
  for (const auto &[edge, segment] : subsegments_)
    out.push_back(
        {{static_cast<Index>(edge >> 32), static_cast<Index>(edge & 0xffffffffu)},
         segment});
  std::sort(out.begin(), out.end(),
            [](const InitialEdge &a, const InitialEdge &b) { return a.edge < b.edge; });
  return out;
}

void WalledMesh::walk_star(Index v, std::vector<Index> &out) {
  out.clear();
  const Index start = vertex_cell[v];
  if (start == none)
    return;
  ++visit_;
  visited_[start] = visit_;
  out.push_back(start);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const Index c = out[k];
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet n = neighbours[c][i];
      if (cells[c][i] == v || !n.exists() || visited_[n.cell()] == visit_)
        continue;
      visited_[n.cell()] = visit_;
      out.push_back(n.cell());
    }
  }
}

void WalledMesh::star_of(Index v, std::vector<Index> &out) {
  if (many_cones_[v])
    out = listed_stars_.at(v);
  else
    walk_star(v, out);
}

void WalledMesh::cells_around(Index a, Index b, std::vector<Index> &out) {
  star_of(a, out);
  std::erase_if(out, [&](Index c) { return !has_vertex(c, b); });
}

Index WalledMesh::add_vertex(const Vector<3> &x, const Carrier &carrier,
                             double radius) {
  points.push_back(x);
  carriers.push_back(carrier);
  insertion_radius.push_back(radius);
  vertex_cell.push_back(none);
  many_cones_.push_back(0);
  return static_cast<Index>(points.size()) - 1;
}

Index WalledMesh::add_cell(const Cell<3> &vertices, Index cell_region) {
  Index c;
  if (free_cells_.empty()) {
    c = static_cast<Index>(cells.size());
    cells.emplace_back();
    neighbours.emplace_back();
    walls.emplace_back();
    region.emplace_back();
    birth.emplace_back();
    visited_.push_back(0);
  } else {
    c = free_cells_.back();
    free_cells_.pop_back();
  }
  cells[c] = vertices;
  neighbours[c].fill(HalfFacet());
  walls[c].fill(none);
  region[c] = cell_region;
  birth[c] = births_++;
  for (Index v : vertices)
    vertex_cell[v] = c;
  return c;
}

void WalledMesh::free_cell(Index c) {
  cells[c][0] = none;
  free_cells_.push_back(c);
}

void WalledMesh::renew_stars(std::span<const Index> dead, std::span<const Index> born) {
  if (listed_stars_.empty())
    return;
  ++visit_;
  for (Index c : dead)
    visited_[c] = visit_;
  for (Index c : dead)
    for (Index v : cells[c])
      if (many_cones_[v])
        std::erase_if(listed_stars_[v], [&](Index k) { return visited_[k] == visit_; });
  for (Index c : born)
    for (Index v : cells[c])
      if (many_cones_[v])
        listed_stars_[v].push_back(c);
}

Tetrahedralisation WalledMesh::extracted() const {
  Tetrahedralisation out;
  out.points = points;
  out.cells.reserve(n_cells());
  out.cell_regions.reserve(n_cells());
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (is_alive(static_cast<Index>(c))) {
      out.cells.push_back(cells[c]);
      out.cell_regions.push_back(region[c]);
    }
  for_each_wall([&](HalfFacet h, Index facet_of_plc) {
    out.walls.push_back(facet(h));
    out.wall_facets.push_back(facet_of_plc);
  });
  for (const auto &[edge, segment] : sorted_subsegments()) {
    out.edges.push_back(edge);
    out.edge_segments.push_back(segment);
  }
  return out;
}

} // namespace anistar::generate
