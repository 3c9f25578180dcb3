#include "surface/ridge_chains.h"

namespace anistar {

RidgeChains::RidgeChains(std::span<const RidgeSegment> segments,
                         std::span<const Index> dimension)
    : links_(segments.size()) {
  std::map<Index, std::vector<std::size_t>> at_point;
  for (std::size_t k = 0; k < segments.size(); ++k)
    for (Index v : segments[k].ends)
      at_point[v].push_back(k);
  const auto is_corner = [&](Index v) { return dimension[v] != 1; };
  const auto trace = [&](std::size_t k, Index from) {
    const Index curve = segments[k].curve, first = from;
    double position = 0;
    for (;;) {
      const auto &ends = segments[k].ends;
      const bool is_reversed = ends[0] != from;
      const Index to = is_reversed ? ends[0] : ends[1];
      links_[k] = {from, to, curve, position, is_reversed};
      position += 1;
      if (is_corner(to) || to == first)
        break;
      const auto &here = at_point[to]; // two segments, as it is no corner
      k = here[here[0] == k ? 1 : 0];
      from = to;
    }
    if (!is_corner(first)) {
      closed_.insert(curve);
      return;
    }
    at_corner_[first].push_back({curve, 0});
    at_corner_[links_[k].to].push_back({curve, position});
  };
  for (bool at_corners : {true, false}) // what is left after the corners is closed
    for (std::size_t k = 0; k < segments.size(); ++k)
      for (Index v : segments[k].ends)
        if (links_[k].curve == none && is_corner(v) == at_corners)
          trace(k, v);
}

std::vector<RidgeChains::Place> RidgeChains::places(Index segment, double part) const {
  const Link &link = links_[segment];
  if (part == 0 || part == 1) {
    const auto corner =
        at_corner_.find((part == 0) != link.is_reversed ? link.from : link.to);
    if (corner != at_corner_.end())
      return corner->second;
  }
  return {{link.curve, link.start + (link.is_reversed ? 1 - part : part)}};
}

} // namespace anistar
