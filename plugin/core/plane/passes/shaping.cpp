#include "plane/passes/shaping.h"

#include "plane/passes/bisection.h"
#include "plane/passes/repair.h"
#include "plane/passes/smooth.h"

#include <optional>

namespace anistar {
namespace {

/// The schedule, found by measurement: length control in between sweeps of smoothing,
/// first wide, then near the bounds of a unit edge; ODT at the end evens the shapes
/// out.
struct Round {
  int pliant_sweeps = 3, odt_sweeps = 0;
  std::optional<LengthBounds> lengths{}; ///< to control after the sweeps
};
constexpr Round schedule[] = {
    {.lengths = LengthBounds{.shortest = .68, .longest = 1.45}},
    {.lengths = LengthBounds{.shortest = .70, .longest = 1.42}},
    {.odt_sweeps = 2}};

/// Outliers of the last sweeps: edges beyond these, cells below this quality.
constexpr LengthBounds outliers{.shortest = .5, .longest = 1.55};
constexpr QualityFloor repair_floor{.between_walls = .5, .elsewhere = .5};

void sweep(Workspace &w, const Run &run, const Round &round) {
  for (int k = 0; k < round.pliant_sweeps; ++k)
    smooth(w, run, Target::unit_edges);
  for (int k = 0; k < round.odt_sweeps; ++k)
    smooth(w, run, Target::odt);
}

} // namespace

ShapeCounts shape(Workspace &w, const Run &run, const QualityFloor &floor) {
  ShapeCounts counts;
  for (const Round &round : schedule) {
    sweep(w, run, round);
    if (round.lengths) {
      counts.lengths += control_lengths(w, run, *round.lengths);
      renumber(w, run.threads); // the new vertices into the blocks where they lie
    }
  }
  counts.lengths += control_lengths(w, run, outliers);
  counts.poor = repair(w, run, {.floor = repair_floor});
  counts.bisections = bisect(w, run, floor);
  return counts;
}

} // namespace anistar
