#include "volume/mesh/slab_team.h"
#include "volume/passes/cell_swap.h"
#include "volume/passes/passes.h"

namespace anistar {
namespace {

/// What one thread does of the pass.
class Swaps {
public:
  Swaps(Volume &view, const Run &run, double quality, std::uint32_t since)
      : view_(view), quality_(quality), since_(since), operator_(view),
        at_cell_(view, operator_, run.hausdorff.surface) {}

  VolumeCounts counts;

  [[nodiscard]] bool is_due(Index c) const {
    return view_.mesh.is_alive(c) && view_.quality_of(c) <= quality_ &&
           view_.cell_clock[c] >= since_;
  }
  void visit(Index c) {
    if (is_due(c))
      (void)at_cell_.swap(c, counts);
  }

private:
  const Volume &view_;
  double quality_;
  std::uint32_t since_;
  CavityOperator operator_;
  CellSwap at_cell_;
};

} // namespace

void swap(Volume &volume, const Run &run, PassLog &log, double quality) {
  const std::uint32_t since = log.begin(Pass::swap, volume);
  SlabTeam<Swaps> team(volume, run,
                       [&](Volume &view) { return Swaps(view, run, quality, since); });
  std::vector<Index> due;
  for (std::size_t c = 0; c < volume.mesh.cells.size(); ++c)
    if (team.first().is_due(static_cast<Index>(c)))
      due.push_back(static_cast<Index>(c));
  log.counts += team.visit(std::move(due), [&](Index c, int round) {
    return volume.state.slabs.of_cell(volume.mesh.at(c), round);
  });
}

} // namespace anistar
