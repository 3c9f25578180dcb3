#pragma once
// The anisotropic Delaunay property of a mesh, simplex by simplex and star by star.
//
// A simplex is Delaunay in a metric M when no vertex that it can reach lies strictly
// inside its M-circumball. Reach: along mesh cells that meet the open ball, never
// across a boundary facet or a constrained facet; ties pass. On a convex domain without
// constraints this is membership in the Delaunay triangulation of all vertices for the
// constant metric M (Boissonnat, Wormser, Yvinec, Anisotropic Delaunay Mesh Generation,
// RR-7712 v2, section 3).

#include "certificate/circumball.h"
#include "mesh/triangulation.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace anistar {

/// The bits of a cell that is Delaunay in the metrics of all its vertices.
template <std::size_t d>
inline constexpr std::uint8_t all_vertices = (1u << (d + 1)) - 1;

/// An answer that looked this many cells away, or more.
inline constexpr std::uint8_t farthest_reach = 255;

/// A mesh as the certificate sees it.
template <std::size_t d> struct CertifiedMesh {
  std::span<const Vertex<d>> vertices;
  std::span<const Cell<d>> cells;
  std::span<const Neighbours<d>> neighbours;
  /// Facets whose entry is not `none` are walls and are not crossed.
  std::span<const std::array<Index, d + 1>> constraints;
};

template <std::size_t d>
[[nodiscard]] CertifiedMesh<d> certified(const Triangulation<d> &mesh) {
  return {mesh.vertices, mesh.cells, mesh.neighbours, mesh.constraints};
}

/// Decides for one simplex and metric after another; one object to a thread.
template <std::size_t d> class DelaunayTest {
public:
  explicit DelaunayTest(CertifiedMesh<d> mesh)
      : mesh_(mesh), stamp_(mesh.cells.size(), 0), known_(mesh.vertices.size()) {}

  /// The first vertex found inside the M-circumball of `cell` that it can reach, `none`
  /// when it is Delaunay.
  [[nodiscard]] Index violator(Index cell, const SymmetricTensor<d> &M);

  /// Bit k: the cell is Delaunay in the metric of its vertex k.
  [[nodiscard]] std::uint8_t bits(Index cell);
  /// How many cells away the last answer of bits() looked.
  [[nodiscard]] std::uint8_t reach() const { return reach_; }

private:
  /// The power of a vertex in the ball of this epoch.
  struct Known {
    std::uint32_t epoch = 0;
    Bounded power;
  };
  CertifiedMesh<d> mesh_;
  std::vector<std::uint32_t> stamp_; ///< per cell, the epoch of its last visit
  std::vector<Known> known_;         ///< per vertex
  std::uint32_t epoch_ = 0;
  /// A facet that meets the open ball, from beyond.
  struct Front {
    HalfFacet entry;
    std::uint8_t depth; ///< in cells
  };
  std::vector<Front> front_;
  std::uint8_t reach_ = 0;

  void begin_walk();
  /// The far side of a facet that is no wall, if the walk has not been there.
  [[nodiscard]] HalfFacet door(Index from, std::size_t i) const;
  void enter(HalfFacet door, std::uint8_t depth);
  [[nodiscard]] Side side(const Circumball<d> &ball, Index v);
  [[nodiscard]] bool meets(const Circumball<d> &ball, const Facet<d> &facet) const;
};

/// Bit k of bits[c]: cell c is Delaunay in the metric of its vertex k. The answer
/// looked reach[c] cells away, at most `farthest_reach`: it holds as long as these do
/// not change.
struct DelaunayBits {
  std::vector<std::uint8_t> bits, reach;
};
/// Hears now and then, on the calling thread, which part is done; what it throws ends
/// the work, and so does false.
using Look = std::function<bool(double fraction)>;

template <std::size_t d>
[[nodiscard]] DelaunayBits delaunay_bits(CertifiedMesh<d> mesh, int threads,
                                         const Look &look);

/// Decides again for some cells.
template <std::size_t d>
void renew_bits(CertifiedMesh<d> mesh, std::span<const Index> cells, int threads,
                const Look &look, DelaunayBits &known);

/// The cells whose answer can depend on a changed one: those that looked as far as it.
/// New cells are changed ones, and have the reach 0.
template <std::size_t d>
[[nodiscard]] std::vector<Index>
dependent_cells(std::span<const Neighbours<d>> neighbours,
                std::span<const Index> changed, std::span<const std::uint8_t> reach);

} // namespace anistar
