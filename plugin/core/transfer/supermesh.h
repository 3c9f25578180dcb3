#pragma once
// The mixed mass matrix of two meshes, assembled over their intersections.

#include "base/monitor.h"
#include "mesh/adjacency.h"
#include "transfer/overlay.h"

#include <cstdint>
#include <span>
#include <vector>

namespace anistar {

/// A mesh whose cells carry the number of their region, from 0.
template <std::size_t d> struct RegionMesh {
  std::span<const Vector<d>> points;
  std::span<const Cell<d>> cells;
  std::span<const Index> regions; ///< of every cell
};

/// A sparse matrix by rows.
struct SparseRows {
  std::vector<std::int64_t> starts;
  std::vector<Index> columns;
  std::vector<double> values;
};

struct SupermeshSettings {
  bool points = true; ///< assemble the matrix between the points
  bool blocks = true; ///< keep the moments of every pair
  /// Values at the corners of the source's cells, one row of `n_columns` for each;
  /// their loads need no memory for the blocks.
  std::span<const double> nodal = {};
  std::size_t n_columns = 0;
  int threads = 1;
};

template <std::size_t d> struct Supermesh {
  /// Integrals of hat functions, target point by source point.
  SparseRows points;
  /// Volumes that source cells give to target cells, fills included.
  SparseRows pairs;
  /// One for each pair, in the order of `pairs`.
  std::vector<Moments<d>> blocks;
  /// Integrals of the nodal values times each barycentric coordinate of every target
  /// cell, one row of columns for each.
  std::vector<double> loads;
  /// Volume of every target cell that its region in the source leaves uncovered.
  std::vector<double> uncovered;
  /// From the middle of that volume to the source, in mesh units.
  std::vector<double> distance;
  /// Volume of every source cell that is covered by target cells.
  std::vector<double> covered;
};

/// Lays the target over the source, region by region.
/// @pre positively oriented cells, regions not negative.
/// @throws std::invalid_argument when a region of the target is none of the source.
template <std::size_t d>
[[nodiscard]] Supermesh<d>
supermesh(const RegionMesh<d> &source, const RegionMesh<d> &target,
          const SupermeshSettings &settings, Monitor &monitor);

} // namespace anistar
