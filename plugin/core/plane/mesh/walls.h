#pragma once
// What a mesh may run into when its boundary moves outward.

#include "mesh/triangulation.h"
#include "plane/geometry/curves.h"
#include "plane/geometry/outline.h"
#include "search/box_tree.h"

#include <span>
#include <utility>
#include <vector>

namespace anistar {

/// The boundary edges of a mesh on its curves, found by place. Cells that stay positive
/// keep the inside of a mesh valid, but not its outside: across a thin hole or a gap an
/// edge that gives way could run into another part of the boundary.
///
/// The tree is built once. An edge that takes the place of another is looked up where
/// that one was, in a box that grows.
class Walls {
public:
  /// The three must outlive this object; only positions of vertices, and entries of the
  /// table of curve edges, may change between calls.
  Walls(const Triangulation<2> &mesh, const std::vector<CurveEdge> &edges,
        const Geometry &geometry);

  /// Whether the boundary edge from a to b may go around by x: the triangle a, b, x
  /// lies on the inner side of the curve, or no other boundary edge meets it.
  /// @param a_index, b_index vertices at a and b, `none` for a place without a vertex
  /// @param replaced entries of the table that the change does away with
  [[nodiscard]] bool is_clear(const Curve &curve, const Vector<2> &a, Index a_index,
                              const Vector<2> &b, Index b_index, const Vector<2> &x,
                              std::span<const Index> replaced) const;

  /// The entry `now` of the table stands where `before` was, which may be gone.
  void add(Index now, Index before);
  void remove(Index gone);
  /// The entry covers the point x as well.
  void extend(Index entry, const Vector<2> &x);

private:
  const Triangulation<2> &mesh_;
  const std::vector<CurveEdge> &edges_;
  std::vector<std::vector<Index>> entries_; ///< at each place of the tree
  std::vector<Index> place_;                ///< per entry, none for interfaces
  BoxTree<2> tree_;

  [[nodiscard]] Index place(Index entry) const {
    return entry >= 0 && std::cmp_less(entry, place_.size()) ? place_[entry] : none;
  }
  [[nodiscard]] std::vector<Box<2>> collect(const Geometry &geometry);
  [[nodiscard]] const Vector<2> &x(Index v) const { return mesh_.vertex(v).x; }
};

} // namespace anistar
