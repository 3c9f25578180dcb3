#pragma once
// The ridges of a volume mesh: a graph of edges that changes with the mesh.

#include "mesh/adjacency.h"

#include <array>
#include <vector>

namespace anistar {

/// An edge of a ridge, linked into the lists of its two ends.
struct RidgeEdge {
  std::array<Index, 2> ends{none, none}; ///< none when the slot is free
  Index curve = none;
  std::array<Index, 2> next{none, none};
};

class RidgeGraph {
public:
  void resize(std::size_t n_vertices) { first_.resize(n_vertices, none); }
  void add(Index a, Index b, Index curve);
  void remove(Index edge);
  /// The edge between a and b, or none.
  [[nodiscard]] Index find(Index a, Index b) const;
  /// Gives the edges at v to visit(edge, other end).
  template <class Visit> void around(Index v, Visit visit) const {
    for (Index e = first_[v]; e != none;) {
      const RidgeEdge &edge = at(e);
      const std::size_t side = edge.ends[0] == v ? 0 : 1;
      visit(e, edge.ends[1 - side]);
      e = edge.next[side];
    }
  }
  [[nodiscard]] const RidgeEdge &at(Index edge) const { return edges_[edge]; }
  [[nodiscard]] const std::vector<RidgeEdge> &edges() const { return edges_; }
  /// Replaces the edge ab by a-v and v-b.
  void split(Index a, Index b, Index v);
  /// Replaces the edges u-v and v-w by u-w.
  void contract(Index v, Index u);
  /// @param rank the new index of every vertex, none for those that are gone.
  void renumber(const std::vector<Index> &rank, std::size_t n_vertices);

private:
  std::vector<RidgeEdge> edges_;
  std::vector<Index> free_, first_;

  void unlink(Index edge, Index v);
};

} // namespace anistar
