#include "volume/passes/cell_swap.h"
#include "volume/passes/collapse.h"
#include "volume/passes/edge_split.h"

namespace anistar {
namespace {

/// Splits of shorter edges do not help.
constexpr double shortest_repaired = 1.2;
/// What collapses and splits must bring the worst cell.
constexpr double least_gain = 1e-3;

class Repair {
public:
  Repair(Volume &volume, const Run &run)
      : volume_(volume), run_(run), operator_(volume),
        at_cell_(volume, operator_, run.hausdorff.surface),
        vertex_(volume, operator_, run), edge_(volume, operator_, run) {}

  VolumeCounts counts;

  void repair_below(double quality) {
    const std::size_t n = volume_.mesh.cells.size();
    for (std::size_t k = 0; k < n && run_.goes_on(k, n); ++k) {
      const auto c = static_cast<Index>(k);
      if (volume_.mesh.is_alive(c) && volume_.quality_of(c) < quality)
        counts.repairs += at_cell_.swap(c, counts) || collapse(c) || split(c);
    }
  }
  [[nodiscard]] bool is_full() const { return edge_.is_full(); }

private:
  Volume &volume_;
  const Run &run_;
  CavityOperator operator_;
  CellSwap at_cell_;
  Collapse vertex_;
  EdgeSplit edge_;
  std::vector<Index> star_;

  [[nodiscard]] bool collapse(Index c) {
    const Cell<3> cell = volume_.mesh.at(c);
    for (Index v : cell) {
      if (volume_.feature(v) == Triangulation<3>::corner)
        continue;
      star_of(volume_, v, star_);
      vertex_.gather(v, star_);
      for (Index u : cell)
        if (u != v && vertex_.may_go_to(u) &&
            vertex_.go_to(u, improvement(least_gain, run_.hausdorff.surface)))
          return true;
    }
    return false;
  }

  [[nodiscard]] bool split(Index c) {
    const Triangulation<3> &mesh = volume_.mesh;
    const Cell<3> cell = mesh.at(c);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        if (fast_length(mesh.vertex(cell[i]), mesh.vertex(cell[j])) >=
                shortest_repaired &&
            edge_.split(c, cell[i], cell[j], {}, improvement(least_gain)))
          return true;
    return false;
  }
};

} // namespace

void repair(Volume &volume, const Run &run, PassLog &log, double quality) {
  ++volume.clock;
  Repair pass(volume, run);
  pass.repair_below(quality);
  log.counts += pass.counts;
  log.is_full = log.is_full || pass.is_full();
}

} // namespace anistar
