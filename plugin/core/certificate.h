#pragma once
// The anisotropic Delaunay property of a mesh, simplex by simplex and star by star.
//
// A simplex is Delaunay in a metric M when no vertex that it can reach lies strictly
// inside its M-circumball. Reach: along mesh cells that meet the open ball, never
// across a boundary facet or a constrained facet; ties pass. On a convex domain without
// constraints this is membership in the Delaunay triangulation of all vertices for the
// constant metric M (Boissonnat, Wormser, Yvinec, Anisotropic Delaunay Mesh Generation,
// RR-7712 v2, section 3).

#include "adjacency.h"
#include "measures.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace anistar {

/// The bits of a cell that is Delaunay in the metrics of all its vertices.
inline constexpr std::uint8_t all_vertices = 7;

/// A mesh as the certificate sees it.
template <std::size_t d> struct CertifiedMesh {
  std::span<const Vertex<d>> vertices;
  std::span<const Cell<d>> cells;
  std::span<const Neighbours<d>> neighbours;
  /// Facets whose entry is not `none` are walls and are not crossed.
  std::span<const std::array<Index, d + 1>> constraints;
};

/// Decides for one simplex and metric after another; one object to a thread.
class DelaunayTest {
public:
  explicit DelaunayTest(CertifiedMesh<2> mesh)
      : mesh_(mesh), stamp_(mesh.cells.size(), 0) {}

  /// The first vertex found inside the M-circumball of `cell` that it can reach, `none`
  /// when it is Delaunay.
  [[nodiscard]] Index violator(Index cell, const SymmetricTensor<2> &M);

  /// Bit k: the cell is Delaunay in the metric of its vertex k.
  [[nodiscard]] std::uint8_t bits(Index cell);
  /// How many cells away the last answer of bits() looked.
  [[nodiscard]] std::uint8_t reach() const { return reach_; }

private:
  CertifiedMesh<2> mesh_;
  std::vector<std::uint32_t> stamp_;
  std::uint32_t epoch_ = 0;

  /// A facet that meets the open ball, as seen from its far cell, and the powers of its
  /// vertices.
  struct Front {
    HalfFacet entry;
    std::uint8_t depth; ///< in cells
    Power first, second;
  };
  std::vector<Front> front_;
  std::uint8_t reach_ = 0;
};

/// Bit k of bits[c]: cell c is Delaunay in the metric of its vertex k. The answer
/// looked reach[c] cells away, 255 for that or more: it holds as long as these do not
/// change.
struct DelaunayBits {
  std::vector<std::uint8_t> bits, reach;
};
[[nodiscard]] DelaunayBits delaunay_bits(CertifiedMesh<2> mesh, int threads);

} // namespace anistar
