#pragma once
// What all phases of one call share beside the mesh.

#include "base/monitor.h"
#include "base/random.h"

namespace anistar {

/// Largest distances of curves and of surfaces from an edge, relative to its length.
struct HausdorffNumbers {
  double curve, surface;
};

struct Run {
  Monitor &monitor;
  HausdorffNumbers hausdorff{};
  Seed seed{};
  int threads = 1;

  [[nodiscard]] bool is_stopped() const {
    return monitor.reason() != StopReason::finished;
  }
  /// Whether a loop over n items goes on with item k; cheap enough for every one.
  [[nodiscard]] bool goes_on(std::size_t k, std::size_t n) const {
    return monitor.keep_going(0, static_cast<double>(k) / static_cast<double>(n));
  }
  /// The same for items that take a while.
  [[nodiscard]] bool look(std::size_t k, std::size_t n) const {
    return monitor.look(static_cast<double>(k) / static_cast<double>(n));
  }
  /// The same run with random streams of its own: for what runs again in every round.
  [[nodiscard]] Run in_round(int round) const {
    Run again = *this;
    again.seed.round = static_cast<std::uint32_t>(round);
    return again;
  }
};

} // namespace anistar
