#include "volume/passes/passes.h"

namespace anistar {

VolumeCounts &VolumeCounts::operator+=(const VolumeCounts &other) {
  splits += other.splits;
  collapses += other.collapses;
  edge_swaps += other.edge_swaps;
  face_swaps += other.face_swaps;
  moves += other.moves;
  insertions += other.insertions;
  repairs += other.repairs;
  return *this;
}

std::uint32_t PassLog::begin(Pass pass, Volume &volume) {
  return std::exchange(last[static_cast<std::size_t>(pass)], ++volume.clock);
}

double least_quality(const Volume &volume) {
  double least = 1;
  for (std::size_t c = 0; c < volume.mesh.cells.size(); ++c)
    if (volume.mesh.is_alive(static_cast<Index>(c)))
      least = std::min(least, volume.quality_of(static_cast<Index>(c)));
  return least;
}

} // namespace anistar
