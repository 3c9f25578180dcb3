#pragma once
// How hard agreement tries, and when its rounds end.

#include "stars/agreement.h"

#include <optional>

namespace anistar {

/// How much is tried where directed steps find nothing more.
struct AgreementEffort {
  double trials_per_cell; ///< places
  double mended_part;     ///< cells are mended when no more of them fail than this part
  int patience = 1;       ///< so many times the rounds and trials
};
/// What a mesh gets unasked: the directed steps and a little more.
inline constexpr AgreementEffort small_effort{.trials_per_cell = .25,
                                              .mended_part = .005};
/// As long as it helps. A bound on the trial places: the metrics that could be
/// certified, but for a few cells, took a third of it.
inline constexpr AgreementEffort full_effort{.trials_per_cell = 20, .mended_part = .03};

/// With so few failing facets a round costs nothing.
inline constexpr std::size_t few_failing_facets = 100;

class RoundLimits {
public:
  RoundLimits(const AgreementEffort &effort, std::size_t n_cells, std::size_t failing)
      : patience_(effort.patience),
        affordable_(effort.patience *
                    (effort.trials_per_cell * double(n_cells) + fewest_trials)),
        left_(nearly_none + n_cells / cells_per_facet_left), fewest_(failing) {}

  [[nodiscard]] int last_round() const { return patience_ * max_rounds; }
  /// Why no round follows on one that leaves so many failing facets.
  /// @param trials made so far
  /// @param per_facet those that the next round takes
  [[nodiscard]] std::optional<AgreementStop>
  stop(std::size_t failing, std::size_t trials, std::size_t per_facet) {
    ++since_;
    if (double(failing) < (1 - least_reduction) * double(fewest_)) {
      fewest_ = failing;
      since_ = 0;
    }
    if (failing > left_ && double(trials + per_facet * failing) > affordable_)
      return AgreementStop::trials;
    if (since_ >=
        patience_ * (failing <= few_failing_facets ? patience_with_few : patience))
      return AgreementStop::stalled;
    return {};
  }

private:
  static constexpr int max_rounds = 120;
  /// Rounds that may pass without clearly fewer failing facets; more when only a few
  /// are left.
  static constexpr int patience = 9, patience_with_few = 45;
  static constexpr double least_reduction = .05;
  /// So many trials are made whatever the number of cells.
  static constexpr double fewest_trials = 65000;
  /// With no more failing facets than this, and one for so many cells, it would be a
  /// pity to stop.
  static constexpr std::size_t nearly_none = 20, cells_per_facet_left = 2000;

  int patience_;
  double affordable_; ///< trials
  std::size_t left_, fewest_;
  int since_ = 0; ///< rounds since there were clearly fewer
};

} // namespace anistar
