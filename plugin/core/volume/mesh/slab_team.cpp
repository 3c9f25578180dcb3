#include "volume/mesh/slab_team.h"

namespace anistar {

void deal_free_cells(Volume &volume, std::vector<SlabWork> &work) {
  // re-insertions and swaps make one more cell now and then; what finds no room is put
  // off
  const auto share = [](const SlabWork &of) { return of.waiting.size() / 8 + 64; };
  std::size_t needed = 0;
  for (const SlabWork &of_slab : work)
    needed += share(of_slab);
  std::vector<Index> free = std::exchange(volume.mesh.free_cells, {});
  while (free.size() < needed) {
    free.push_back(volume.add_cell());
    volume.mesh.at(free.back())[0] = none;
  }
  for (SlabWork &of_slab : work) {
    const auto first = free.end() - static_cast<std::ptrdiff_t>(share(of_slab));
    of_slab.free_cells.assign(first, free.end());
    free.erase(first, free.end());
  }
  volume.mesh.free_cells = std::move(free);
}

std::vector<Index> collect(Volume &volume, const std::vector<SlabWork> &work) {
  const auto append = [](std::vector<Index> &to, const std::vector<Index> &from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  std::vector<Index> put_off;
  for (const SlabWork &of_slab : work) {
    append(put_off, of_slab.put_off);
    append(volume.free_vertices, of_slab.removed);
    append(volume.mesh.free_cells, of_slab.free_cells);
  }
  return put_off;
}

} // namespace anistar
