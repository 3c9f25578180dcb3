#pragma once
// A tetrahedralisation of the whole space: the outside of the convex hull is filled
// with cells that join its facets to one ghost vertex, so that no facet is without
// neighbour.

#include "mesh/adjacency.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace anistar::generate {

/// The vertex at infinity.
inline constexpr Index ghost = none;

/// Tells, walk after walk, what has been visited, without clearing anything.
class Visits {
public:
  void start(std::size_t n) {
    ++walk_;
    last_.resize(n, 0);
  }
  /// @returns whether it is the first time on this walk
  bool visit(Index item) {
    if (last_[item] == walk_)
      return false;
    last_[item] = walk_;
    return true;
  }
  [[nodiscard]] bool has(Index item) const { return last_[item] == walk_; }

private:
  std::vector<std::uint32_t> last_;
  std::uint32_t walk_ = 0;
};

/// A facet of a new cell, which waits for the cell on the other side.
struct OpenFacet {
  std::array<Index, 3> vertices; ///< in increasing order
  HalfFacet side;
  Index wall;
};

[[nodiscard]] std::array<Index, 3> sorted(std::array<Index, 3> vertices);

/// An edge of the mesh and a cell at it.
struct EdgePlace {
  Index from, to, cell;
};

class GhostMesh {
public:
  explicit GhostMesh(std::size_t n_points) : vertex_cell_(n_points, none) {}

  [[nodiscard]] Index n_slots() const { return static_cast<Index>(cells_.size()); }
  [[nodiscard]] std::size_t n_cells() const { return cells_.size() - free_.size(); }
  [[nodiscard]] const Cell<3> &cell(Index c) const { return cells_[c].vertices; }
  [[nodiscard]] bool is_alive(Index c) const { return cells_[c].is_alive; }
  [[nodiscard]] HalfFacet opposite(HalfFacet h) const {
    return cells_[h.cell()].neighbours[h.facet()];
  }
  /// What the facet is part of, `none` if it is no wall.
  [[nodiscard]] Index wall(HalfFacet h) const {
    return cells_[h.cell()].walls[h.facet()];
  }
  [[nodiscard]] Facet<3> facet(HalfFacet h) const {
    return facet_of<3>(cell(h.cell()), h.facet());
  }
  [[nodiscard]] Index apex(HalfFacet h) const { return cell(h.cell())[h.facet()]; }
  [[nodiscard]] Index cell_at(Index vertex) const { return vertex_cell_[vertex]; }
  [[nodiscard]] std::optional<std::size_t> ghost_index(Index c) const {
    return index_of(c, ghost);
  }
  [[nodiscard]] bool is_ghost(Index c) const { return ghost_index(c).has_value(); }
  /// The place of a vertex in a cell.
  [[nodiscard]] std::optional<std::size_t> index_of(Index c, Index vertex) const;

  void add_vertex() { vertex_cell_.push_back(none); }
  [[nodiscard]] Index add(const Cell<3> &vertices);
  void remove(Index c);
  void join(HalfFacet one, HalfFacet other);
  /// Makes a wall of both sides of a facet, or none.
  void set_wall(HalfFacet h, Index wall);
  /// Joins facets with the same vertices, each of which there are two, and makes walls
  /// of those where one is.
  /// @returns whether every facet found its other side
  [[nodiscard]] bool join(std::vector<OpenFacet> &open);
  /// Puts other cells in the place of some; walls stay where they were.
  /// @returns the new ones, or nothing if they do not fit, and the mesh is broken
  [[nodiscard]] std::optional<std::vector<Index>>
  replace(std::span<const Index> old, std::span<const Cell<3>> cells);
  [[nodiscard]] OpenFacet open_facet(HalfFacet h, Index wall) const {
    return {sorted(facet(h)), h, wall};
  }

  /// The cells at a vertex; valid until the next call of any of these.
  [[nodiscard]] const std::vector<Index> &star(Index vertex) const;
  /// A cell at the edge, if it is one.
  [[nodiscard]] std::optional<EdgePlace> find_edge(Index from, Index to) const;
  /// The cells round an edge, each as the facet through which the next one is entered;
  /// the first is that of the place.
  void ring(const EdgePlace &edge, std::vector<HalfFacet> &cells) const;

private:
  struct Slot {
    Cell<3> vertices;
    Neighbours<3> neighbours;
    std::array<Index, 4> walls;
    bool is_alive;
  };
  std::vector<Slot> cells_;
  std::vector<Index> free_;
  PerVertex<Index> vertex_cell_;
  mutable Visits visits_;
  mutable std::vector<Index> star_;
};

} // namespace anistar::generate
