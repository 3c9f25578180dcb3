#include "volume/passes/slab_team.h"

namespace anistar {

std::vector<std::vector<Index>>
deal_free_cells(Volume &volume, const std::vector<std::vector<Index>> &items) {
  // re-insertions and swaps make one more cell now and then; what finds no room is put
  // off
  const auto share = [](std::size_t n) { return n / 8 + 64; };
  std::size_t needed = 0;
  for (const std::vector<Index> &of_slab : items)
    needed += share(of_slab.size());
  std::vector<Index> free = std::exchange(volume.mesh.free_cells, {});
  while (free.size() < needed) {
    free.push_back(volume.add_cell());
    volume.mesh.at(free.back())[0] = none;
  }
  std::vector<std::vector<Index>> dealt;
  for (const std::vector<Index> &of_slab : items) {
    const auto first = free.end() - static_cast<std::ptrdiff_t>(share(of_slab.size()));
    dealt.emplace_back(first, free.end());
    free.erase(first, free.end());
  }
  volume.mesh.free_cells = std::move(free);
  return dealt;
}

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

} // namespace anistar
