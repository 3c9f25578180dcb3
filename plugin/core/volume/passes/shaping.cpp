#include "volume/passes/shaping.h"

#include "remesh/kept_quality.h"

namespace anistar {
namespace {

/// Lengths are brought down step by step: larger steps leave pockets where the cells
/// are stuck, and splitting everything at once makes far too many vertices.
constexpr double growth_step = 1.5;
constexpr double longest_edge = 1.5;
constexpr int max_surface_rounds = 12;
constexpr int max_growth_rounds = 60, max_converged_rounds = 6;
/// The next step is taken, and growth ends, when a round splits fewer than these
/// fractions of the vertices.
constexpr double step_is_dry = .02, growth_is_dry = .03;
/// Growth ends as well when a round changes the number of vertices by less than this:
/// where the metric is steep some edges are split and collapsed for ever. Or when the
/// repairs take away this fraction of what was split. A step above the last ends after
/// as many such rounds, for the next one to go on elsewhere.
constexpr double steady = .01, undone = .5;
constexpr int max_steady_rounds = 2;
/// The mesh is sorted again when it has grown by this.
constexpr double growth_between_sorts = 1.6;
/// Or when this fraction of its vertices came or went; but while it grows not one of so
/// few cells, which the cache holds in any order.
constexpr double change_between_sorts = .1;
constexpr std::size_t cached_cells = 1 << 15;
/// Sweeps over the whole mesh at its final size.
constexpr int n_sweeps = 3;
/// Where the metric is steep, all is polished, several times; else what is below this.
constexpr int n_steep_polishes = 3;
constexpr double polished_below = .5;

/// Repairs of what is below the quality that is kept, at the end.
constexpr int n_last_repairs = 2;
/// It is kept when no cell is below this part of it: the passes compute in single
/// precision.
constexpr double kept_part = .999;

/// Keeps a mesh sorted along its curve while vertices come and go: what is near in
/// space must be near in memory, or most of the time goes into waiting for it.
class CurveOrder {
public:
  CurveOrder(Volume &volume, const VolumePasses &passes, int threads)
      : volume_(volume), passes_(passes), threads_(threads),
        n_vertices_(volume.n_vertices()) {}

  void restore() {
    const bool has_grown = static_cast<double>(volume_.mesh.vertices.size()) >
                           growth_between_sorts * static_cast<double>(n_vertices_);
    const bool is_scattered =
        volume_.mesh.cells.size() > cached_cells && has_changed(n_changes_);
    if (!has_grown && !is_scattered)
      return;
    renumber(volume_, threads_);
    n_vertices_ = volume_.n_vertices();
    n_changes_ = n_changes();
  }
  void finish() {
    if (has_changed(0))
      renumber(volume_, threads_);
  }

private:
  Volume &volume_;
  const VolumePasses &passes_;
  int threads_;
  std::size_t n_vertices_, n_changes_ = 0; ///< at the last sort

  [[nodiscard]] std::size_t n_changes() const {
    return passes_.counts().splits + passes_.counts().collapses;
  }
  [[nodiscard]] bool has_changed(std::size_t since) const {
    return static_cast<double>(n_changes() - since) >
           change_between_sorts * static_cast<double>(volume_.n_vertices());
  }
};

/// Phase 2: the longest edges first, with swaps, moves and re-insertion in between.
void grow(Volume &volume, VolumePasses &passes, const Run &run) {
  for (int round = 0; round < max_surface_rounds; ++round)
    if (passes.follow_surfaces() == 0)
      break;
  double threshold = std::max(longest_edge, passes.longest_edge() / growth_step);
  CurveOrder order(volume, passes, run.threads);
  int converged = 0, n_steady = 0;
  bool is_lowered = false;
  for (int round = 0; round < max_growth_rounds && !run.is_stopped(); ++round) {
    const bool is_last_step = threshold <= longest_edge;
    if (is_lowered)
      passes.look_everywhere(Pass::split);
    const auto before = static_cast<double>(volume.n_vertices());
    const std::size_t splits = passes.split({threshold, 1e-4, .45, .5});
    passes.swap(.5);
    passes.vertices({is_last_step ? .6 : .5, std::max(longest_edge, threshold), true});
    order.restore();
    const auto unrepaired = static_cast<double>(volume.n_vertices());
    passes.repair(.1);
    const auto after = static_cast<double>(volume.n_vertices());
    const double fraction = static_cast<double>(splits) / after;
    const bool is_steady =
        std::abs(after / before - 1) < steady ||
        (splits > 0 && unrepaired - after > undone * static_cast<double>(splits));
    if (is_last_step &&
        (fraction < growth_is_dry || is_steady || ++converged >= max_converged_rounds))
      break;
    n_steady = is_steady ? n_steady + 1 : 0;
    is_lowered =
        !is_last_step && (fraction < step_is_dry || n_steady >= max_steady_rounds);
    if (is_lowered) {
      threshold = std::max(longest_edge, threshold / growth_step);
      n_steady = 0;
    }
  }
  order.finish();
}

void mend(VolumePasses &passes, double kept) {
  if (passes.least_quality() < kept)
    passes.repair(kept);
}

/// Phase 3: sweeps at the final size.
void shape(VolumePasses &passes, const Run &run, double kept) {
  mend(passes, kept);
  for (int sweep = 0; sweep < n_sweeps && !run.is_stopped(); ++sweep) {
    (void)passes.split({longest_edge, .15, .5});
    passes.swap(.7);
    passes.vertices({.62, longest_edge, sweep + 1 < n_sweeps});
    passes.repair(.3);
  }
  passes.swap(.7);
  const bool is_steep = passes.is_metric_steep();
  for (int k = 0; k < (is_steep ? n_steep_polishes : 1) && !run.is_stopped(); ++k) {
    if (k > 0)
      (void)passes.split({longest_edge, .25, .5});
    passes.polish(is_steep ? 1 : polished_below);
  }
  for (int k = 0; k < n_last_repairs && !run.is_stopped(); ++k)
    mend(passes, kept);
}

/// When a mesh begins to keep its least quality. Most get better cells if they may be
/// poor for a while, as long as they grow; not where a surface curves within the
/// thickness of the part that it bounds.
enum class Keeping { at_final_size, always };

/// The mesh after phases 2 and 3.
Shaping attempt(Volume start, Keeping keeping, const Run &run, Stopwatch &watch) {
  auto volume = std::make_unique<Volume>(std::move(start));
  const double kept =
      kept_quality<3>(volume->mesh.vertices, volume->mesh.cells, run.threads);
  VolumePasses passes(*volume, run);
  watch.phase("size");
  volume->state.kept_quality = keeping == Keeping::always ? kept : 0;
  grow(*volume, passes, run);
  watch.phase("shape");
  volume->state.kept_quality = kept;
  shape(passes, run, kept);
  renumber(*volume, run.threads);
  return {std::move(volume), passes.counts(), passes.is_full(), kept,
          passes.least_quality()};
}

} // namespace

Shaping shape_volume(const std::function<Volume()> &start, const Run &run,
                     Stopwatch &watch) {
  const auto make = [&](Keeping keeping) {
    return attempt(start(), keeping, run, watch);
  };
  const auto is_complete = [&](const Shaping &made) {
    return !made.is_full && !run.is_stopped();
  };
  Shaping first = make(Keeping::at_final_size);
  if (first.least >= kept_part * first.kept || !is_complete(first))
    return first;
  watch.phase("size");
  Shaping second = make(Keeping::always);
  return is_complete(second) && second.least > first.least ? std::move(second)
                                                           : std::move(first);
}

} // namespace anistar
