#pragma once
// What ends the rounds of insertions of Algorithm 2, in both dimensions.

#include "base/monitor.h"

namespace anistar {

struct RoundBounds {
  int max_rounds;
  int patience;         ///< rounds that bring nothing
  double most_vertices; ///< the mesh may grow to

  /// Why no round follows on those done; empty when one does.
  [[nodiscard]] std::string stop(bool is_consistent, int rounds, int without_gain,
                                 std::size_t n_vertices, Monitor &monitor) const {
    if (is_consistent)
      return "consistent";
    if (rounds == max_rounds)
      return "max_rounds";
    if (static_cast<double>(n_vertices) > most_vertices)
      return "max_growth";
    if (without_gain > patience)
      return "stalled";
    if (!monitor.keep_going(n_vertices, 0) ||
        !monitor.look(double(rounds) / max_rounds))
      return name_of(monitor.reason());
    return "";
  }
};

} // namespace anistar
