#pragma once
// Points that enter a mesh of triangles by their metric-Delaunay cavity: Algorithm 1 of
// RR-7712 v2 on one valid mesh, and what Pick_valid (Algorithm 3) asks of a point.

#include "plane/mesh/edits.h"
#include "stars/algorithm_2.h"

namespace anistar {

/// Quasi-cospherical configurations that a point would make: edges of its star and of
/// its link on which the four metrics would disagree.
struct Hits {
  int n = 0;

  [[nodiscard]] bool is_better(const Hits &other) const { return n < other.n; }
};

/// The cavity of one point after another.
class Insertion {
public:
  explicit Insertion(Workspace &w) : w_(w), mesh_(w.mesh) {}

  /// Takes up a point: the cells around it whose M_p-ball contains it.
  /// @returns false when it does not see all of their boundary or comes too near to a
  /// vertex.
  [[nodiscard]] bool gather(const Vertex<2> &p, Index cell);
  /// A constrained edge of the cell that p encroaches upon: it lies in a surface ball
  /// of one of its ends.
  [[nodiscard]] HalfFacet encroached(const Vertex<2> &p, Index cell) const;
  /// @param radius circumradius up to which hits count
  /// @pre gather(p, ...) was true and nothing changed since.
  [[nodiscard]] Hits score(const Vertex<2> &p, double radius);
  /// The cells that were gathered become the star of p. @returns the new vertex
  Index enter(const Vertex<2> &p, Index background_cell);

private:
  struct Spoke { ///< a facet of the cavity by its first vertex
    Index first;
    HalfFacet facet;
  };

  Workspace &w_;
  Triangulation<2> &mesh_;
  std::vector<Spoke> spokes_;
};

} // namespace anistar
