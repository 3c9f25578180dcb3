#pragma once
// The anisotropic Delaunay property of a mesh, simplex by simplex and star by star.
//
// A simplex is Delaunay in a metric M when no vertex that it can reach lies strictly
// inside its M-circumball. Reach: along mesh cells that meet the open ball, never
// across a boundary facet or a constrained facet; ties pass. On a convex domain without
// constraints this is membership in the Delaunay triangulation of all vertices for the
// constant metric M (Boissonnat, Wormser, Yvinec, Anisotropic Delaunay Mesh Generation,
// RR-7712 v2, section 3).

#include "certificate/certified_mesh.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace anistar {

/// The bits of a cell that is Delaunay in the metrics of all its vertices.
template <std::size_t d>
inline constexpr std::uint8_t all_vertices = (1u << (d + 1)) - 1;

/// Bit k of bits[c]: cell c is Delaunay in the metric of its vertex k. The answers for
/// the metric of v looked reach[v] cells away from the star of v, at most
/// `farthest_reach`: they hold as long as these and the star do not change.
struct DelaunayBits {
  PerCell<std::uint8_t> bits;
  PerVertex<std::uint8_t> reach;
};
/// Hears now and then, on the calling thread, which part is done; what it throws ends
/// the work, and so does false.
using Look = std::function<bool(double fraction)>;

template <std::size_t d>
[[nodiscard]] DelaunayBits delaunay_bits(CertifiedMesh<d> mesh, int threads,
                                         const Look &look);

/// Decides again for the stars whose answers can depend on cells that have changed or
/// are new: those that looked as far as one of them.
template <std::size_t d>
void renew_bits(CertifiedMesh<d> mesh, std::span<const Index> changed, int threads,
                const Look &look, DelaunayBits &known);

} // namespace anistar
