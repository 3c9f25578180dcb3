#include "volume/passes/passes.h"

namespace anistar {
namespace {

/// Splits of shorter edges do not help.
constexpr double shortest_repaired = 1.2;

} // namespace

void VolumePasses::repair(double quality) {
  ++volume_.clock;
  const std::size_t n = volume_.mesh.cells.size();
  for (std::size_t k = 0; k < n && go_on(k, n); ++k) {
    const auto c = static_cast<Index>(k);
    if (volume_.mesh.is_alive(c) && volume_.quality_of(c) < quality && repair_cell(c))
      ++counts_.repairs;
  }
}

double VolumePasses::least_quality() const {
  double least = 1;
  for (std::size_t c = 0; c < volume_.mesh.cells.size(); ++c)
    if (volume_.mesh.is_alive(static_cast<Index>(c)))
      least = std::min(least, volume_.quality_of(static_cast<Index>(c)));
  return least;
}

bool VolumePasses::repair_cell(Index c) {
  const Triangulation<3> &mesh = volume_.mesh;
  if (swap_cell(c))
    return true;
  const Cell<3> cell = mesh.at(c);
  for (Index v : cell) {
    if (volume_.feature(v) == Triangulation<3>::corner)
      continue;
    star_of(volume_, v, star_);
    if (volume_.feature(v) == 2)
      note_surface_neighbours(v);
    for (Index u : cell)
      if (u != v && may_collapse(v, u) &&
          collapse(v, u, improvement(1e-3, run_.hausdorff.surface)))
        return true;
  }
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      if (fast_length(mesh.vertex(cell[i]), mesh.vertex(cell[j])) >=
              shortest_repaired &&
          split_edge(c, cell[i], cell[j], {0, 0}, improvement()))
        return true;
  return false;
}

} // namespace anistar
