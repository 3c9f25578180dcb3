#pragma once
// The mesh that is being refined: tetrahedra of the inside alone, with walls.
//
// A wall is a facet of the mesh that is part of a facet of the complex (a subfacet of
// the slides), a subsegment an edge that is part of one of its segments. Walls belong
// to the cells at them and subsegments to a table, so that nothing else has to follow a
// change.

#include "base/predicates.h"
#include "generate/refinement/mesh/carrier.h"
#include "generate/tetrahedralisation.h"

#include <map>
#include <unordered_map>
#include <vector>

namespace anistar::generate {

/// Edge k of a wall, opposite its vertex k, seen from the cell of the half-facet.
struct WallEdge {
  HalfFacet wall;
  std::size_t k;
};

struct WalledMesh {
  PerVertex<Vector<3>> points;
  PerVertex<Carrier> carriers;
  PerVertex<double> insertion_radius; ///< r_v of the slides
  PerVertex<Index> vertex_cell;       ///< one cell of its star

  PerCell<Cell<3>> cells; ///< cells[c][0] == none when c is free
  PerCell<Neighbours<3>> neighbours;
  PerCell<std::array<Index, 4>> walls; ///< the facet of the complex, or none
  PerCell<Index> region;
  PerCell<std::uint32_t> birth; ///< tells a cell from another that had its place

  struct InitialEdge {
    Segment edge;
    Index segment;
  };
  std::vector<InitialEdge> initial_edges;
  std::size_t n_segments = 0, n_facets = 0, n_initial_points = 0;

  /// @throws std::invalid_argument when a wall is no facet of the cells
  explicit WalledMesh(const Tetrahedralisation &input);

  [[nodiscard]] HalfFacet opposite(HalfFacet h) const {
    return neighbours[h.cell()][h.facet()];
  }
  [[nodiscard]] Index wall(HalfFacet h) const { return walls[h.cell()][h.facet()]; }
  [[nodiscard]] Facet<3> facet(HalfFacet h) const {
    return facet_of<3>(cells[h.cell()], h.facet());
  }
  [[nodiscard]] Index apex(HalfFacet h) const { return cells[h.cell()][h.facet()]; }
  [[nodiscard]] bool is_alive(Index c) const { return cells[c][0] != none; }
  [[nodiscard]] std::size_t n_cells() const {
    return cells.size() - free_cells_.size();
  }
  [[nodiscard]] Simplex<3> simplex(Index c) const {
    const Cell<3> &v = cells[c];
    return {points[v[0]], points[v[1]], points[v[2]], points[v[3]]};
  }
  [[nodiscard]] std::size_t local_index(Index c, Index v) const {
    const Cell<3> &cell = cells[c];
    return cell[0] == v ? 0 : cell[1] == v ? 1 : cell[2] == v ? 2 : 3;
  }
  [[nodiscard]] bool has_vertex(Index c, Index v) const {
    const Cell<3> &cell = cells[c];
    return cell[0] == v || cell[1] == v || cell[2] == v || cell[3] == v;
  }
  /// The half-facet of a cell with these vertices; none if it has no such facet.
  [[nodiscard]] HalfFacet half_facet(Index c, const Facet<3> &vertices) const;

  /// The ends of an edge of a wall and the third vertex, so that ends, third vertex and
  /// apex are a positive cell.
  [[nodiscard]] Facet<3> turned(const WallEdge &edge) const {
    const Facet<3> f = facet(edge.wall);
    return {f[(edge.k + 1) % 3], f[(edge.k + 2) % 3], f[edge.k]};
  }
  /// The vertex of a facet other than x and y.
  [[nodiscard]] Index third_vertex(HalfFacet h, Index x, Index y) const;
  /// The first wall that one meets turning around an edge from a wall, on its side; not
  /// any if the turn leaves the mesh where no wall is.
  [[nodiscard]] HalfFacet next_wall(const WallEdge &edge) const;

  /// The segment that an edge is part of, or none.
  [[nodiscard]] Index segment_of(Index a, Index b) const {
    if (!carriers[a].is_on_segment() || !carriers[b].is_on_segment())
      return none;
    const auto found = subsegments_.find(key(a, b));
    return found == subsegments_.end() ? none : found->second;
  }
  void split_subsegment(const Segment &edge, Index middle);
  [[nodiscard]] std::size_t n_subsegments() const { return subsegments_.size(); }
  /// All of them, sorted.
  [[nodiscard]] std::vector<InitialEdge> sorted_subsegments() const;

  /// The cells with both vertices, in all fans around their edge.
  void cells_around(Index a, Index b, std::vector<Index> &out);
  /// The cells of a vertex, in all cones.
  void star_of(Index v, std::vector<Index> &out);

  [[nodiscard]] Index add_vertex(const Vector<3> &x, const Carrier &carrier,
                                 double radius);
  /// A cell that is joined to nothing yet.
  [[nodiscard]] Index add_cell(const Cell<3> &vertices, Index cell_region);
  void free_cell(Index c);
  void join(HalfFacet h, HalfFacet other) {
    neighbours[h.cell()][h.facet()] = other;
    if (other.exists())
      neighbours[other.cell()][other.facet()] = h;
  }
  /// What the stars that are kept as lists lose and gain.
  void renew_stars(std::span<const Index> dead, std::span<const Index> born);
  [[nodiscard]] bool has_many_cones(Index v) const { return many_cones_[v] != 0; }

  /// visit(half-facet, facet of the complex), for each wall from one of its sides.
  template <class Visit> void for_each_wall(Visit visit) const {
    for_each_half_wall([&](HalfFacet h, Index facet_of_plc) {
      const HalfFacet other = opposite(h);
      if (!other.exists() || h < other)
        visit(h, facet_of_plc);
    });
  }
  /// From both.
  template <class Visit> void for_each_half_wall(Visit visit) const {
    for (std::size_t c = 0; c < cells.size(); ++c)
      if (is_alive(static_cast<Index>(c)))
        for (std::size_t i = 0; i < 4; ++i)
          if (walls[c][i] != none)
            visit(HalfFacet(static_cast<Index>(c), i), walls[c][i]);
  }

  /// Cells, walls and subsegments as they are now; unused places are dropped.
  [[nodiscard]] Tetrahedralisation extracted() const;

private:
  using Key = std::uint64_t;
  [[nodiscard]] static Key key(Index a, Index b) {
    return static_cast<Key>(std::min(a, b)) << 32 | static_cast<Key>(std::max(a, b));
  }

  std::unordered_map<Key, Index> subsegments_; // looked up, never run through
  std::vector<Index> free_cells_;
  std::uint32_t births_ = 0;
  // Where parts of the inside touch at a vertex alone, its star has several cones, and
  // no walk leads from one to another.
  PerVertex<std::uint8_t> many_cones_;
  std::map<Index, std::vector<Index>> listed_stars_;
  PerCell<std::uint32_t> visited_;
  std::uint32_t visit_ = 0;

  void put_walls(const Tetrahedralisation &input);
  void find_carriers();
  void find_many_cones();
  void find_insertion_radii();
  void walk_star(Index v, std::vector<Index> &out);
};

} // namespace anistar::generate
