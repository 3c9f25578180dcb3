#pragma once
// Makes every facet a union of facets of the mesh, once its edges are there.

#include "base/monitor.h"
#include "generate/constrained/facets/facet_triangles.h"
#include "generate/constrained/mesh/ghost_mesh.h"
#include "generate/constrained/points/exact_points.h"
#include "generate/constrained/recovery/facet_side.h"
#include "generate/constrained/recovery/facet_walk.h"
#include "generate/constrained/recovery/gift_wrapping.h"

#include <string>
#include <vector>

namespace anistar::generate {

/// A cell that a facet passes through is removed with all it can reach through facets
/// that cross the plane; the halves of this cavity are filled on their own, the one
/// above first, as it decides on the triangles between them.
class FacetRecovery {
public:
  struct Counts {
    std::size_t missing = 0; ///< planes of which parts were missing
    std::size_t cavities = 0, largest_cavity = 0, rejections = 0;
  };

  FacetRecovery(const ExactPoints &points, GhostMesh &mesh,
                const FacetTriangles &facets)
      : points_(points), mesh_(mesh), facets_(facets), side_(points),
        walk_(mesh, facets, side_) {}

  /// The walls of the mesh are numbers of planes afterwards; their cells on the
  /// positive side see them in the sense of the plane.
  /// @throws MeshingError where two facets cross; BudgetSpent
  Counts run(Monitor &monitor);

private:
  const ExactPoints &points_;
  GhostMesh &mesh_;
  const FacetTriangles &facets_;
  FacetSide side_;
  FacetWalk walk_;
  Index plane_ = none;
  Counts counts_;
  Visits in_cavity_;

  void recover(const std::vector<Index> &triangles, Monitor &monitor);
  void carve(Index crossed, Monitor &monitor);
  [[nodiscard]] std::vector<Index> collect_cavity(Index crossed);
  [[nodiscard]] std::array<HalfCavity, 2> halves(const std::vector<Index> &cavity);
  [[nodiscard]] bool is_crossed(HalfFacet h);
  void refuse_crossing_edges(HalfFacet h);
  [[noreturn]] void refuse_crossing(HalfFacet h) const;
  [[noreturn]] void refuse(const std::string &other, const Vector<3> &place) const;
  [[nodiscard]] static std::string name_of(Index facet);
  [[noreturn]] void give_up(const std::string &why) const;
};

} // namespace anistar::generate
