#pragma once
// Edge removals and facet swaps at one cell of a volume mesh.

#include "volume/mesh/cavity_operator.h"
#include "volume/mesh/shell.h"
#include "volume/passes/passes.h"

namespace anistar {

class CellSwap {
public:
  /// @param hausdorff_number of curved surfaces, relative to an edge
  CellSwap(Volume &volume, CavityOperator &op, double hausdorff_number)
      : volume_(volume), operator_(op), hausdorff_number_(hausdorff_number) {}

  /// Removes an edge of the cell, or swaps a facet of it, where that improves the worst
  /// cell there. @returns whether it did; in a slab it may be put off.
  [[nodiscard]] bool swap(Index c, VolumeCounts &counts);

private:
  Volume &volume_;
  CavityOperator &operator_;
  double hausdorff_number_;
  Shell shell_;
  double gain_ = 0; ///< what the worst cell must gain

  [[nodiscard]] bool remove_edge(Index c, Index a, Index b);
  [[nodiscard]] bool is_ring_inside();
  [[nodiscard]] bool is_ring_better(std::size_t apex, double threshold) const;
  [[nodiscard]] bool swap_facet(HalfFacet h);
};

} // namespace anistar
