#pragma once
// Lawson flips in a blended metric.

#include "mesh/blocks.h"
#include "plane/mesh/cavity.h"

#include <utility>

namespace anistar {

/// Restores the blended Delaunay property around changed cells. An edge is flipped when
/// the opposite vertex lies inside the circumscribed ellipse for the mean of the four
/// metrics, each scaled to determinant one.
///
/// That mean differs from edge to edge, so there is no potential that must fall and
/// flips can cycle: every run is capped, and a run that meets its cap is counted.
class Legaliser {
public:
  explicit Legaliser(Triangulation<2> &mesh) : mesh_(mesh), cavity_(mesh) {}

  /// From now on flips only edges whose two cells have all their vertices in the range.
  void restrict_to(const VertexRange &range) { range_ = range; }

  void push(HalfFacet edge) { stack_.push_back(edge); }
  /// All edges of the star of v and of its link.
  void push_star(Index v);
  /// Of these only the edges whose two cells have no vertex after v: the last one of
  /// the four to be visited in a sweep pushes an edge, once.
  void push_finished(Index v, std::span<const HalfFacet> star);

  /// Flips until the stack is empty or `cap` flips were made. The cells that changed
  /// are appended to `changed` when given.
  void run(int cap, std::vector<Index> *changed = nullptr);

  /// Takes over what another one has counted, and lets that one start anew.
  void take_counts(Legaliser &other) {
    n_flips_ += std::exchange(other.n_flips_, 0);
    n_capped_ += std::exchange(other.n_capped_, 0);
  }
  [[nodiscard]] std::size_t n_flips() const { return n_flips_; }
  [[nodiscard]] std::size_t n_capped() const { return n_capped_; }

private:
  Triangulation<2> &mesh_;
  VertexRange range_;
  Cavity cavity_;
  std::vector<HalfFacet> stack_, star_;
  std::size_t n_flips_ = 0, n_capped_ = 0;

  [[nodiscard]] bool wants_flip(HalfFacet edge) const;
};

/// The cavity of an edge's two cells, bounded for the star of one opposite vertex.
/// @returns false when they do not form a strictly convex quadrilateral, or the edge is
/// constrained.
[[nodiscard]] bool bound_swap(const Triangulation<2> &mesh, HalfFacet edge,
                              Cavity &cavity);

} // namespace anistar
