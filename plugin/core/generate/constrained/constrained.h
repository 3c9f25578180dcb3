#pragma once
// The constrained Delaunay tetrahedralisation of a piecewise linear complex.

#include "base/monitor.h"
#include "generate/constrained/regions/region_rule.h"
#include "generate/tetrahedralisation.h"

namespace anistar::generate {

struct ConstrainedSettings {
  /// Of the complex, which must be vertices though nothing ends there; other points
  /// that no triangle or segment uses are left out.
  std::vector<Index> kept_points;
  RegionChoice regions;
  /// Whether nearly planar facets may consist of other triangles than those given; else
  /// the surface stays as it is, at the price of more points.
  bool facets_may_flip = true;
};

/// What was done on the way.
struct ConstrainedCounts {
  std::size_t missing_edges = 0, steiner_points = 0, steiner_points_in_facets = 0;
  std::size_t flips = 0;
  std::size_t rigid_facets =
      0; ///< that kept their triangles, as flips did not end there
  std::size_t missing_facets = 0, cavities = 0, largest_cavity = 0, rejections = 0;
  std::size_t peeled = 0;                    ///< flat cells given to the outside
  std::size_t removed = 0;                   ///< edges taken out of flat cells
  std::size_t steiner_points_in_volumes = 0; ///< with cells in place of flat ones
  std::size_t flat_left = 0;                 ///< cells that are flat still
  std::size_t flat_on_flat_walls = 0;        ///< of these, as triangles of facets are
  std::size_t moved = 0; ///< Steiner points moved along their edge, against flat cells
  std::size_t predicates = 0, exact_predicates = 0;
};

struct Constrained {
  Tetrahedralisation mesh;
  ConstrainedCounts counts;
};

/// Si and Gaertner, 3D boundary recovery by constrained Delaunay tetrahedralization,
/// 2011, with exact Steiner points and gift-wrapped cavities.
/// @throws MeshingError that names what cannot be meshed and where, BudgetSpent
[[nodiscard]] Constrained
constrained_tetrahedralisation(const Plc &plc, const ConstrainedSettings &settings,
                               Monitor &monitor);

} // namespace anistar::generate
