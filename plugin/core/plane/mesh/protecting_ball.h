#pragma once
// The protecting ball of a sharp corner, in the mesh.

#include "plane/mesh/sliding_vertex.h"
#include "plane/mesh/vertex_trial.h"

#include <optional>

namespace anistar {

/// Changes the radius of a ball: the vertices of its shell slide along their legs at
/// once and stay at one distance from the corner, in the metric of the corner.
class ProtectingBall {
public:
  /// @pre the balls of the curve edges stay as they are while this object lives.
  explicit ProtectingBall(Workspace &w);

  /// Takes up the ball on whose shell v is. @returns false when there is none, or a leg
  /// cannot follow: it is frozen, or ends on the shell.
  [[nodiscard]] bool gather(Index v);
  /// Puts the shell at `factor` times the radius. @returns false, and leaves all as it
  /// was, when the mesh or a curve does not allow it.
  [[nodiscard]] bool resize(double factor);
  /// Whether the number of disagreeing edges is lower by `least` than before, within
  /// the bounds of a relocation.
  [[nodiscard]] bool drops(int least) const;
  /// Whether the worst cell at the shell is better than before.
  [[nodiscard]] bool raises_quality() const;
  void undo();
  void commit() const;
  [[nodiscard]] const std::vector<Index> &shell() const { return shell_; }

private:
  struct Leg {
    PlaneTrial trial;
    SlidingVertex on;
    StarScore before;
    double dt = 0;
  };

  Workspace &w_;
  std::vector<std::vector<Index>> entries_; ///< curve edges across each ball
  std::vector<Index> shell_;
  std::vector<Leg> legs_;
  std::vector<HalfFacet> edges_; ///< of the legs' stars and of their links, each once
  int disagreeing_before_ = 0;

  void gather_edges();
  [[nodiscard]] int count_disagreeing() const;
  [[nodiscard]] std::optional<double> step_to(const Leg &leg, double factor) const;
  void put_back(std::size_t n_legs);
};

} // namespace anistar
