#pragma once
// What cells of a plane mesh are poor.

#include "mesh/triangulation.h"

namespace anistar {

struct QualityFloor {
  double between_walls; ///< of cells whose vertices all lie on curves
  double elsewhere;     ///< of the others, and where the metric is steep

  [[nodiscard]] bool is_met(const Triangulation<2> &mesh, Index cell) const;
};

/// The cells below a floor.
[[nodiscard]] std::vector<Index> poor_cells(const Triangulation<2> &mesh,
                                            const QualityFloor &floor, int threads);

[[nodiscard]] double quality_of(const Triangulation<2> &mesh, Index cell);

} // namespace anistar
