#pragma once
// The anisotropic Delaunay property of a mesh, simplex by simplex and star by star.
//
// A simplex is Delaunay in a metric M when no vertex that it can reach lies strictly
// inside its M-circumball. Reach: along mesh cells that meet the open ball, never across
// a boundary facet or a constrained facet; ties pass. On a convex domain without
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

/// A mesh as the certificate sees it.
template <std::size_t d> struct CertifiedMesh {
  std::span<const Vertex<d>> vertices;
  std::span<const Cell<d>> cells;
  std::span<const Neighbours<d>> neighbours;
  /// Bit i of walls[c]: facet i of cell c is not crossed.
  std::span<const std::uint8_t> walls;
};

/// Decides for one simplex and metric after another; one object to a thread.
class DelaunayTest {
public:
  explicit DelaunayTest(const CertifiedMesh<2> &mesh)
      : mesh_(mesh), stamp_(mesh.cells.size(), 0) {}

  /// The first vertex found inside the M-circumball of `cell` that it can reach, `none`
  /// when it is Delaunay.
  [[nodiscard]] Index violator(Index cell, const SymmetricTensor<2> &M);

private:
  const CertifiedMesh<2> &mesh_;
  std::vector<std::uint32_t> stamp_;
  std::uint32_t epoch_ = 0;
  std::vector<HalfFacet> front_;
};

/// Bit k of result[c]: cell c is Delaunay in the metric of its vertex k.
[[nodiscard]] std::vector<std::uint8_t> delaunay_bits(const CertifiedMesh<2> &mesh,
                                                      int threads);

} // namespace anistar
