#pragma once
// Where a curve is cut into edges.

#include "base/run.h"
#include "plane/geometry/protection.h"

namespace anistar {

/// Parameters of the vertices of a curve, from 0 to its end, for edges of equal metric
/// length near 1, each of which keeps to the curve within the Hausdorff bound of the
/// run; a frozen curve keeps its points.
/// @throws BudgetSpent when the time is up
/// @throws MeshingError where the curve is torn apart, so that no edge keeps to it
[[nodiscard]] std::vector<double> unit_cuts(const Curve &curve,
                                            const LengthTable &table,
                                            const Shells &shells, const Run &run);

/// All the points of the geometry on a curve.
[[nodiscard]] std::vector<double> own_points(const Curve &curve);

/// As few of them as keep the curve within the bound; of a frozen one all.
[[nodiscard]] std::vector<double> fewest_points(const Curve &curve, double hausdorff);

} // namespace anistar
