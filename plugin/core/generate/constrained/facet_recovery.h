#pragma once
// Makes every facet a union of facets of the mesh, once its edges are there.

#include "base/monitor.h"
#include "generate/constrained/exact_points.h"
#include "generate/constrained/facet_side.h"
#include "generate/constrained/facet_triangles.h"
#include "generate/constrained/ghost_mesh.h"
#include "generate/constrained/gift_wrapping.h"

#include <string>
#include <vector>

namespace anistar::generate {

/// Walks over the plane of each facet from its edges on. A cell that the facet passes
/// through is removed with all it can reach through facets that cross the plane; the
/// halves of this cavity are filled on their own, the one above first, as it decides on
/// the triangles between them.
class FacetRecovery {
public:
  struct Counts {
    std::size_t missing = 0; ///< planes of which parts were missing
    std::size_t cavities = 0, largest_cavity = 0, rejections = 0;
  };

  FacetRecovery(const ExactPoints &points, GhostMesh &mesh,
                const FacetTriangles &facets)
      : points_(points), mesh_(mesh), facets_(facets), side_(points) {}

  /// The walls of the mesh are numbers of planes afterwards; their cells on the
  /// positive side see them in the sense of the plane.
  /// @throws MeshingError where two facets cross; BudgetSpent
  Counts run(Monitor &monitor);

private:
  /// An edge of the mesh in a plane, with the facet on its left, seen from above.
  struct Border {
    Index from, to;
  };

  const ExactPoints &points_;
  GhostMesh &mesh_;
  const FacetTriangles &facets_;
  FacetSide side_;
  Index plane_ = none;
  Counts counts_;
  Visits in_cavity_, noted_;
  std::vector<HalfFacet> found_; ///< facets of the mesh in the plane, from above
  std::vector<HalfFacet> ring_;

  void recover(const std::vector<Index> &triangles, Monitor &monitor);
  [[nodiscard]] bool find_triangles(const std::vector<Index> &triangles);
  [[nodiscard]] HalfFacet find_triangle(const Facet<3> &triangle);
  [[nodiscard]] HalfFacet from_above(HalfFacet h, const Facet<3> &triangle) const;
  [[nodiscard]] Index walk(const std::vector<Index> &triangles);
  [[nodiscard]] std::vector<Border> borders(const std::vector<Index> &triangles) const;
  [[nodiscard]] HalfFacet look_left(const Border &border, Index &crossed);

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
