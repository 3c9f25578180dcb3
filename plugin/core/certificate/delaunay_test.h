#pragma once
// Whether one simplex is Delaunay in one metric, or one facet in the surface star of a
// vertex, exactly, by the walk of the definition.

#include "certificate/certified_mesh.h"
#include "certificate/circumball.h"

#include <vector>

namespace anistar {

/// Decides for one simplex and metric after another; one object to a thread.
template <std::size_t d> class DelaunayTest {
public:
  explicit DelaunayTest(CertifiedMesh<d> mesh)
      : mesh_(mesh), stamp_(mesh.cells.size(), 0), known_(mesh.vertices.size()) {}

  /// The first vertex found inside the M-circumball of `cell` that it can reach, `none`
  /// when it is Delaunay.
  [[nodiscard]] Index violator(Index cell, const SymmetricTensor<d> &M);
  /// The same for the M-surface ball of a facet, which reaches from the cells on both
  /// sides of it. @param seen the facet as the vertex with the metric M sees it
  [[nodiscard]] Index violator(HalfFacet facet, const SymmetricTensor<d> &M,
                               const SurfaceFacet<d> &seen);
  /// How many cells away the last of these calls looked.
  [[nodiscard]] std::uint8_t reach() const { return reach_; }
  /// And at how many.
  [[nodiscard]] std::size_t n_visits() const { return front_.size(); }

  /// Bit k: the cell is Delaunay in the metric of its vertex k.
  [[nodiscard]] std::uint8_t bits(Index cell);

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
  [[nodiscard]] Index walk(const Circumball<d> &ball);
  /// The far side of a facet that is no wall, if the walk has not been there.
  [[nodiscard]] HalfFacet door(Index from, std::size_t i) const;
  void enter(HalfFacet door, std::uint8_t depth);
  [[nodiscard]] Side side(const Circumball<d> &ball, Index v);
  [[nodiscard]] bool meets(const Circumball<d> &ball, const Facet<d> &facet) const;
};

} // namespace anistar
