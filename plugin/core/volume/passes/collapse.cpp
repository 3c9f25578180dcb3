#include "volume/passes/collapse.h"

namespace anistar {

void Collapse::gather(Index v, std::span<const Index> star) {
  v_ = v;
  star_ = star;
  if (volume_.feature(v) == 2)
    note_surface_neighbours();
}

void Collapse::note_surface_neighbours() {
  const Triangulation<3> &mesh = volume_.mesh;
  on_surface_.clear();
  for (Index c : star_) {
    if (!volume_.is_walled(c))
      continue;
    const std::size_t at = mesh.local_index(c, v_);
    for (std::size_t i = 0; i < 4; ++i) {
      if (i == at || mesh.constraint(HalfFacet(c, i)) == none)
        continue;
      for (std::size_t j = 0; j < 4; ++j)
        if (j != i && j != at)
          on_surface_.push_back(mesh.at(c)[j]);
    }
  }
}

bool Collapse::may_go_to(Index u) const {
  switch (volume_.feature(v_)) {
  case 3:
    return true;
  case 2:
    return std::find(on_surface_.begin(), on_surface_.end(), u) != on_surface_.end();
  case 1: {
    if (volume_.ridges.find(v_, u) == none)
      return false;
    const Index other = beyond(u);
    return other != none && volume_.ridges.find(u, other) == none;
  }
  default:
    return false;
  }
}

/// The other neighbour of v along its ridge.
Index Collapse::beyond(Index u) const {
  Index found = none;
  volume_.ridges.around(v_, [&](Index, Index other) {
    if (other != u)
      found = other;
  });
  return found;
}

/// Whether the ridge stays near its curve when v goes to its neighbour u.
bool Collapse::follows_curve(Index u) const {
  return !volume_.surface.strays(1, volume_.support_of(v_), volume_.mesh.vertex(u),
                                 volume_.mesh.vertex(beyond(u)), run_.hausdorff.curve);
}

bool Collapse::go_to(Index u, const Acceptance &acceptance) {
  const bool is_on_ridge = volume_.feature(v_) == 1;
  if (is_on_ridge && !follows_curve(u))
    return false;
  if (!operator_.replace(star_, u, {v_, none}, acceptance))
    return false;
  if (is_on_ridge)
    volume_.ridges.contract(v_, u);
  volume_.remove_vertex(v_);
  return true;
}

} // namespace anistar
