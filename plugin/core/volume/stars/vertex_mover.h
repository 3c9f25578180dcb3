#pragma once
// Vertices that leave the mesh and enter it again at another place, by their cavity.

#include "base/random.h"
#include "volume/stars/insertion.h"

namespace anistar {

/// What a move must do.
struct MoveDemand {
  int trials;       ///< places that are tried at each distance
  int most_failing; ///< bound of the change in the number of failing facets
};

/// Algorithm 3 for a vertex that is there already: its star is its cavity, as far as
/// the cells that its ball contains at the new place. Moves by one operation what
/// relocation and re-insertion would do by two. Vertices of curved surfaces and ridges
/// stay where they are.
class VertexMover {
public:
  VertexMover(Volume &volume, VolumeInsertion &insertion, CavityOperator &op,
              double sigma_0)
      : volume_(volume), insertion_(insertion), operator_(op), sigma_0_(sigma_0) {}

  /// Tries its own place and random ones. @returns whether the cost went down; the
  /// vertices around are insertion.link().
  bool move(Index v, const MoveDemand &demand, CounterRandom &random);

private:
  Volume &volume_;
  VolumeInsertion &insertion_;
  CavityOperator &operator_;
  double sigma_0_;
  std::vector<Index> star_;

  [[nodiscard]] bool is_free(Index v) const;
  [[nodiscard]] ScoredPlace best_place(Index v, int trials, CounterRandom &random);
};

} // namespace anistar
