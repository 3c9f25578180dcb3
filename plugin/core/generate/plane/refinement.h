#pragma once
// Delaunay refinement in the plane.

#include "base/monitor.h"
#include "generate/plane/input_angles.h"
#include "generate/plane/plane_mesh.h"

#include <span>

namespace anistar::generate {

/// What triangles are to be like.
struct PlaneCriteria {
  double bound;                       ///< of circumradius over shortest edge
  PerVertex<double> sizes;            ///< wanted length of edges at every vertex
  std::span<const Index> region_tags; ///< in increasing order
  std::span<const double> region_sizes;
};

/// What was done, and what was left.
struct PlaneRefinementCounts {
  std::size_t split_segments = 0;  ///< points on segments
  std::size_t off_centres = 0;     ///< points in triangles
  std::size_t rejected = 0;        ///< points that encroached a segment
  std::size_t at_small_angles = 0; ///< triangles left at small angles of the input
  std::size_t refused = 0; ///< triangles and segments left: no room between doubles
};

/// Inserts points until no segment is encroached, no triangle is larger than its size
/// and none is worse than the bound but at angles of the input below 60 degrees. There
/// segments are divided on concentric circles, and triangles whose shortest edge spans
/// the angle are left.
/// It ends for bounds of 1.123 (26.4 degrees) and more; for others the monitor sees to
/// it. The mesh is constrained Delaunay at any time.
///
/// Ruppert, A Delaunay refinement algorithm for quality 2-dimensional mesh generation,
/// 1995; Miller, Pav, Walkington, When and why Ruppert's algorithm works, 2003.
/// Differs from them in that at angles below 15 degrees the ends of the shortest edge
/// may be at any distance from the apex.
/// @param angles of the input, whose points are the first of the mesh
[[nodiscard]] PlaneRefinementCounts refine(PlaneMesh &mesh, const InputAngles &angles,
                                           PlaneCriteria criteria, Monitor &monitor);

} // namespace anistar::generate
