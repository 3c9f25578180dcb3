#pragma once
// The collapse of a vertex of a volume mesh onto a neighbour.

#include "base/run.h"
#include "volume/mesh/cavity_operator.h"

namespace anistar {

/// A vertex with its star: gather(v, star), then ask where it may go, and let it.
class Collapse {
public:
  Collapse(Volume &volume, CavityOperator &op, const Run &run)
      : volume_(volume), operator_(op), run_(run) {}

  /// Takes up a vertex. @param star its cells, which stay as they are
  void gather(Index v, std::span<const Index> star);
  /// Whether it may go to a vertex of its star: along its ridge, or on its surface.
  [[nodiscard]] bool may_go_to(Index u) const;
  /// Removes it, and joins what it was joined to with u; @returns whether it did.
  [[nodiscard]] bool go_to(Index u, const Acceptance &acceptance);

private:
  Volume &volume_;
  CavityOperator &operator_;
  const Run &run_;
  Index v_ = none;
  std::span<const Index> star_;
  std::vector<Index> on_surface_; ///< neighbours along edges of the surface of v

  void note_surface_neighbours();
  [[nodiscard]] Index beyond(Index u) const;
  [[nodiscard]] bool follows_curve(Index u) const;
};

} // namespace anistar
