#pragma once
// The metric length of a curve.

#include "base/monitor.h"
#include "metric/background.h"
#include "plane/geometry/curves.h"

#include <vector>

namespace anistar {

/// A curve's metric length, tabulated over its parameter.
struct LengthTable {
  std::vector<double> parameter{0}, length{0};

  [[nodiscard]] double total() const { return length.back(); }
  /// The parameter at metric length s from the beginning.
  [[nodiscard]] double parameter_at(double s) const;
  /// Its inverse.
  [[nodiscard]] double length_at(double t) const;
};

/// @param limit metric length beyond which the request is absurd and sampling stops
/// @param n_vertices there are before this curve
/// @throws BudgetSpent when the time is up, or there are to be more vertices than the
/// monitor allows
[[nodiscard]] LengthTable tabulate_length(const Curve &curve,
                                          const Background<2> &background, double limit,
                                          std::size_t n_vertices, Monitor &monitor);

} // namespace anistar
