#pragma once
// The passes over a volume mesh.

#include "base/run.h"
#include "volume/mesh/volume.h"

namespace anistar {

/// Operations made.
struct VolumeCounts {
  std::size_t splits = 0, collapses = 0, edge_swaps = 0, face_swaps = 0, moves = 0,
              insertions = 0, repairs = 0;

  VolumeCounts &operator+=(const VolumeCounts &other);
};

/// The passes that look only at the cells and vertices that changed since they last
/// ran.
enum class Pass { split, swap, vertex, polish };

/// What the passes over one mesh leave to those that follow.
struct PassLog {
  VolumeCounts counts;
  bool is_full = false; ///< a split had to be left out for want of vertices
  std::array<std::uint32_t, 4>
      last{}; ///< when each pass last ran, by the volume's clock

  /// @returns the clock since when changes are due.
  std::uint32_t begin(Pass pass, Volume &volume);
  /// Makes a pass look at everything the next time.
  void look_everywhere(Pass pass) { last[static_cast<std::size_t>(pass)] = 0; }
};

struct SplitRule {
  double longest;     ///< edges above are split
  double floor;       ///< of the quality
  double closest = 0; ///< nearest a new vertex may come to the others around the edge
  double share = 0;   ///< of the old quality that is enough too (see Acceptance)
};
/// Splits the longest edge of every cell that is too long, and edges that stray from
/// their curved surface or ridge; @returns how many.
std::size_t split(Volume &volume, const Run &run, PassLog &log, const SplitRule &rule);
/// Splits edges of curved surfaces and ridges that stray from them, while the cells
/// there are thick enough to let the new vertices pass; @returns how many.
std::size_t follow_surfaces(Volume &volume, const Run &run, PassLog &log);

/// Edge removals and facet swaps at cells below `quality`, where they improve.
void swap(Volume &volume, const Run &run, PassLog &log, double quality);

struct VertexRule {
  double shortest, longest; ///< edges below are collapsed unless that makes some above
  bool reinsert;
  double collapse_floor = .15;   ///< of the quality after a collapse
  double reinsertion_floor = .5; ///< and after a re-insertion
};
/// Collapse, move and metric-Delaunay re-insertion of every vertex.
void improve_vertices(Volume &volume, const Run &run, PassLog &log,
                      const VertexRule &rule);

/// Swaps, collapses and splits at cells below `quality`, whatever improves.
void repair(Volume &volume, const Run &run, PassLog &log, double quality);
/// Moves and swaps at cells below `quality` in the measure of the reports.
void polish(Volume &volume, const Run &run, PassLog &log, double quality);

/// Whether that measure differs from the one of the other passes almost everywhere: the
/// metric varies much within half of the cells.
[[nodiscard]] bool is_metric_steep(const Volume &volume);
[[nodiscard]] double longest_edge(const Volume &volume);
/// Of the cells, in the measure of the passes.
[[nodiscard]] double least_quality(const Volume &volume);

} // namespace anistar
