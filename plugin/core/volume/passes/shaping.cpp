#include "volume/passes/shaping.h"

#include "remesh/kept_quality.h"

namespace anistar {
namespace {

/// Edges above this are split in the end. Lengths are brought down to it step by step:
/// larger steps leave pockets where the cells are stuck, and splitting everything at
/// once makes far too many vertices.
constexpr double longest_left = 1.5;
constexpr double growth_step = 1.5;
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
/// A split on the way may make cells of this quality, or this share of the old one: the
/// passes after it improve them. But it may bring vertices no nearer than that.
constexpr double growing_floor = 1e-4, growing_share = .5, growing_closest = .45;
/// Cells below are swapped, and repaired, on the way.
constexpr double growing_swapped = .5, growing_repaired = .1;
/// Edges below are collapsed, and with the last step more of them.
constexpr double growing_shortest = .5, last_step_shortest = .6;
/// The mesh is sorted again when it has grown by this.
constexpr double growth_between_sorts = 1.6;
/// Or when this fraction of its vertices came or went; but while it grows not one of so
/// few cells, which the cache holds in any order.
constexpr double change_between_sorts = .1;
constexpr std::size_t cached_cells = 1 << 15;

/// Sweeps over the whole mesh at its final size, which swap and repair cells below, and
/// collapse edges below.
constexpr int n_sweeps = 3;
constexpr double swapped = .7, repaired = .3, shortest_left = .62;
/// What a split must leave then, and between two polishes; and how near it may bring
/// vertices to each other.
constexpr double split_floor = .15, polished_split_floor = .25, split_closest = .5;
/// Where the metric is steep, all is polished, several times; else what is below this.
constexpr int n_steep_polishes = 3;
constexpr double everything = 1, polished_below = .5;
/// Repairs of what is below the quality that is kept, at the end.
constexpr int n_last_repairs = 2;
/// It is kept when no cell is below this part of it: the passes compute in single
/// precision.
constexpr double kept_part = .999;

/// Keeps a mesh sorted along its curve while vertices come and go: what is near in
/// space must be near in memory, or most of the time goes into waiting for it.
class CurveOrder {
public:
  /// @param counts of the passes over the mesh
  CurveOrder(Volume &volume, const VolumeCounts &counts, int threads)
      : volume_(volume), counts_(counts), threads_(threads),
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
  const VolumeCounts &counts_;
  int threads_;
  std::size_t n_vertices_, n_changes_ = 0; ///< at the last sort

  [[nodiscard]] std::size_t n_changes() const {
    return counts_.splits + counts_.collapses;
  }
  [[nodiscard]] bool has_changed(std::size_t since) const {
    return static_cast<double>(n_changes() - since) >
           change_between_sorts * static_cast<double>(volume_.n_vertices());
  }
};

/// What a round of growth has done, with the numbers of vertices on its way.
struct GrowthRound {
  double splits, before, unrepaired, after;

  [[nodiscard]] double split_fraction() const { return splits / after; }
  [[nodiscard]] bool is_steady() const {
    return std::abs(after / before - 1) < steady ||
           (splits > 0 && unrepaired - after > undone * splits);
  }
};

/// The bound of the lengths on its way down.
class LengthSteps {
public:
  explicit LengthSteps(double longest) : bound_(next_below(longest)) {}

  [[nodiscard]] double bound() const { return bound_; }
  [[nodiscard]] bool is_last() const { return bound_ <= longest_left; }
  /// Whether the bound is a new one.
  [[nodiscard]] bool is_lowered() const { return is_lowered_; }
  /// Lowers the bound when it is time; @returns whether growth goes on.
  [[nodiscard]] bool advance(const GrowthRound &round) {
    is_lowered_ = false;
    if (is_last())
      return round.split_fraction() >= growth_is_dry && !round.is_steady() &&
             ++n_last_ < max_converged_rounds;
    n_steady_ = round.is_steady() ? n_steady_ + 1 : 0;
    is_lowered_ =
        round.split_fraction() < step_is_dry || n_steady_ >= max_steady_rounds;
    if (is_lowered_) {
      bound_ = next_below(bound_);
      n_steady_ = 0;
    }
    return true;
  }

private:
  double bound_;
  int n_last_ = 0, n_steady_ = 0; ///< rounds with the last bound; steady ones
  bool is_lowered_ = false;

  [[nodiscard]] static double next_below(double length) {
    return std::max(longest_left, length / growth_step);
  }
};

GrowthRound grow_once(Volume &volume, const Run &run, PassLog &log, CurveOrder &order,
                      const LengthSteps &steps) {
  const auto n_vertices = [&] { return static_cast<double>(volume.n_vertices()); };
  run.monitor.note_size(volume.n_vertices());
  GrowthRound round{};
  round.before = n_vertices();
  round.splits = static_cast<double>(split(volume, run, log,
                                           {.longest = steps.bound(),
                                            .floor = growing_floor,
                                            .closest = growing_closest,
                                            .share = growing_share}));
  swap(volume, run, log, growing_swapped);
  improve_vertices(volume, run, log,
                   {.shortest = steps.is_last() ? last_step_shortest : growing_shortest,
                    .longest = steps.bound(),
                    .reinsert = true});
  order.restore();
  round.unrepaired = n_vertices();
  repair(volume, run, log, growing_repaired);
  round.after = n_vertices();
  return round;
}

/// Brings the mesh to its size: the longest edges first, with swaps, moves and
/// re-insertion in between.
void grow(Volume &volume, const Run &run, PassLog &log) {
  for (int round = 0; round < max_surface_rounds; ++round)
    if (follow_surfaces(volume, run, log) == 0)
      break;
  LengthSteps steps(longest_edge(volume));
  CurveOrder order(volume, log.counts, run.threads);
  for (int round = 0; round < max_growth_rounds && !run.is_stopped(); ++round) {
    if (steps.is_lowered())
      log.look_everywhere(Pass::split);
    if (!steps.advance(grow_once(volume, run, log, order, steps)))
      break;
  }
  order.finish();
}

void mend(Volume &volume, const Run &run, PassLog &log, double kept) {
  if (least_quality(volume) < kept)
    repair(volume, run, log, kept);
}

void sweep(Volume &volume, const Run &run, PassLog &log, bool is_last) {
  (void)split(
      volume, run, log,
      {.longest = longest_left, .floor = split_floor, .closest = split_closest});
  swap(volume, run, log, swapped);
  improve_vertices(
      volume, run, log,
      {.shortest = shortest_left, .longest = longest_left, .reinsert = !is_last});
  repair(volume, run, log, repaired);
}

void polish_all(Volume &volume, const Run &run, PassLog &log) {
  const bool is_steep = is_metric_steep(volume);
  for (int k = 0; k < (is_steep ? n_steep_polishes : 1) && !run.is_stopped(); ++k) {
    if (k > 0)
      (void)split(volume, run, log,
                  {.longest = longest_left,
                   .floor = polished_split_floor,
                   .closest = split_closest});
    polish(volume, run, log, is_steep ? everything : polished_below);
  }
}

/// Improves the cells at the final size. @param kept no cell is to be below
void shape(Volume &volume, const Run &run, PassLog &log, double kept) {
  mend(volume, run, log, kept);
  for (int k = 0; k < n_sweeps && !run.is_stopped(); ++k)
    sweep(volume, run, log, k + 1 == n_sweeps);
  swap(volume, run, log, swapped);
  polish_all(volume, run, log);
  for (int k = 0; k < n_last_repairs && !run.is_stopped(); ++k)
    mend(volume, run, log, kept);
}

/// When a mesh begins to keep its least quality. Most get better cells if they may be
/// poor for a while, as long as they grow; not where a surface curves within the
/// thickness of the part that it bounds.
enum class Keeping { at_final_size, always };

Shaping attempt(Volume start, Keeping keeping, const Run &run, Stopwatch &watch) {
  Shaping made;
  made.volume = std::make_unique<Volume>(std::move(start));
  Volume &volume = *made.volume;
  made.kept = kept_quality<3>(volume.mesh.vertices, volume.mesh.cells, run.threads);
  PassLog log;
  watch.phase("size");
  volume.state.kept_quality = keeping == Keeping::always ? made.kept : 0;
  grow(volume, run, log);
  run.monitor.note_size(volume.n_vertices());
  watch.phase("shape");
  volume.state.kept_quality = made.kept;
  shape(volume, run, log, made.kept);
  renumber(volume, run.threads);
  made.counts = log.counts;
  made.is_full = log.is_full;
  made.least = least_quality(volume);
  return made;
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
