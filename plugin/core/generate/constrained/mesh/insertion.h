#pragma once
// The insertion of a point into a Delaunay tetrahedralisation (Bowyer and Watson).

#include "generate/constrained/mesh/ghost_mesh.h"
#include "generate/constrained/points/exact_points.h"

#include <span>
#include <vector>

namespace anistar::generate {

class Insertion {
public:
  Insertion(const ExactPoints &points, GhostMesh &mesh)
      : points_(points), mesh_(mesh) {}

  /// Inserts a point of the convex hull, found by a walk from a cell.
  /// @pre the mesh is Delaunay, without walls
  /// @throws MeshingError if the point is a vertex already
  void insert(Index p, Index start);

  /// The vertices of the cells that the last insertion has removed.
  [[nodiscard]] std::span<const Cell<3>> removed() const { return removed_; }

private:
  const ExactPoints &points_;
  GhostMesh &mesh_;
  Visits outside_, inside_;
  std::vector<Index> cavity_;
  std::vector<HalfFacet> border_; ///< of the cavity, seen from the cells that stay
  std::vector<Cell<3>> removed_;
  std::vector<OpenFacet> open_;

  [[nodiscard]] Index locate(Index p, Index start) const;
  [[nodiscard]] bool is_in_conflict(Index c, Index p) const;
  void refuse_vertex(Index c, Index p) const;
  void collect_cavity(Index p, Index start);
  void fill_cavity(Index p);
};

} // namespace anistar::generate
