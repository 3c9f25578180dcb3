#pragma once
// What agreement does and what became of it, for meshes of triangles and tetrahedra:
// the mesh is changed until the metrics of neighbours agree about every facet.

#include "base/monitor.h"

#include <cstddef>

namespace anistar {

/// Why the rounds of agreement ended.
enum class AgreementStop { agreed, stalled, rounds, trials, interrupted };

struct AgreementCounts {
  /// Facets on which metrics disagree: in the plane edges, by the metrics of four
  /// vertices, in space triangles, by those of five.
  std::size_t before = 0, after = 0;
  std::size_t trials = 0, moves = 0;
  // in space only
  std::size_t swaps = 0, reinsertions = 0, repairs = 0, polishes = 0;
  int rounds = 0;
  AgreementStop stop = AgreementStop::agreed;

  /// Adds what the blocks of the plane count side by side.
  AgreementCounts &operator+=(const AgreementCounts &other) {
    trials += other.trials;
    moves += other.moves;
    return *this;
  }
};

/// What became of agreement. Those before `stopped` left the mesh as it was.
enum class AgreementOutcome {
  off,             ///< not wanted
  stopped_before,  ///< a budget had been spent
  varies_too_fast, ///< the metric, see ln_gamma
  stopped,         ///< by a budget
  done
};

struct AgreementReport {
  AgreementOutcome outcome = AgreementOutcome::off;
  AgreementCounts counts{};
  StopReason stopped_by = StopReason::finished;
  /// What forbade it: this quantile of the distortion, and its bound.
  int percent = 0;
  double ln_gamma = 0, largest_ln_gamma = 0;

  [[nodiscard]] bool was_tried() const {
    return outcome == AgreementOutcome::stopped || outcome == AgreementOutcome::done;
  }
};

/// Of agreement that is not made because the metric varies too fast.
[[nodiscard]] inline AgreementReport varies_too_fast(int percent, double ln_gamma,
                                                     double largest) {
  return {.outcome = AgreementOutcome::varies_too_fast,
          .percent = percent,
          .ln_gamma = ln_gamma,
          .largest_ln_gamma = largest};
}

/// What mending has done.
struct MendingCounts {
  std::size_t moves = 0;
  std::ptrdiff_t more_failing = 0; ///< facets that fail now less those mended
};

} // namespace anistar
