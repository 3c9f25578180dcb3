#pragma once
// Exact point location in a mesh that need be neither Delaunay nor convex.

#include "base/deferred.h"
#include "base/predicates.h"
#include "base/tensor.h"
#include "mesh/adjacency.h"
#include "search/box_tree.h"

#include <span>
#include <vector>

namespace anistar {

/// A point of the mesh: barycentric coordinates in a cell. `distance` is that from the
/// query to this point, 0 for queries inside the mesh.
template <std::size_t d> struct Location {
  Index cell = none;
  std::array<double, d + 1> barycentric{};
  double distance = 0;
};

/// Finds the cell of a point by a walk, then by a box tree, and the nearest point of
/// the mesh for points outside. Each tree is made when it is first needed. Safe for
/// concurrent use.
template <std::size_t d> class Locator {
public:
  /// @pre cells positively oriented. @throws std::invalid_argument (see adjacency).
  Locator(std::span<const Vector<d>> points, std::span<const Cell<d>> cells,
          int threads = 1);

  /// @param hint a cell at which the walk starts; `none` goes to the tree at once.
  /// @throws std::domain_error if x is no place (see is_in_range).
  [[nodiscard]] Location<d> locate(const Vector<d> &x, Index hint) const;

  /// Locations of many points; consecutive ones should be near one another.
  [[nodiscard]] std::vector<Location<d>>
  locate_all(std::span<const Vector<d>> queries) const;

  [[nodiscard]] const std::vector<Cell<d>> &cells() const { return cells_; }
  [[nodiscard]] const std::vector<Vector<d>> &points() const { return points_; }
  [[nodiscard]] const std::vector<Neighbours<d>> &neighbours() const {
    return neighbours_;
  }
  [[nodiscard]] const BoxTree<d> &cell_tree() const;
  [[nodiscard]] Simplex<d> simplex(Index cell) const;

private:
  std::vector<Vector<d>> points_;
  std::vector<Cell<d>> cells_;
  std::vector<Neighbours<d>> neighbours_;
  int threads_;

  /// The facets on the boundary.
  struct Boundary {
    std::vector<HalfFacet> facets;
    BoxTree<d> tree;
  };
  Deferred<BoxTree<d>> cell_tree_;
  Deferred<Boundary> boundary_;

  [[nodiscard]] const Boundary &boundary() const;
  [[nodiscard]] Index walk(const Vector<d> &x, Index start) const;
  [[nodiscard]] Index containing(const Vector<d> &x) const;
  [[nodiscard]] Location<d> inside(const Vector<d> &x, Index cell) const;
  [[nodiscard]] Location<d> nearest(const Vector<d> &x) const;
};

} // namespace anistar
