#pragma once
// Vertices inside of the circumballs of cells that are no neighbours of theirs: no
// facet tells of them.

#include "certificate/facet_test.h"
#include "mesh/triangulation.h"

#include <algorithm>
#include <unordered_map>

namespace anistar {

/// The vertices of a cell, in its order, and the one inside of a ball of it.
using FarViolation = std::array<Index, 5>;

/// Each is watched like a facet: its five vertices decide about it in the same way.
class FarViolations {
public:
  void add(const FarViolation &found) {
    std::vector<FarViolation> &known = at_[found[0]];
    if (std::find(known.begin(), known.end(), found) != known.end())
      return;
    for (Index v : found)
      at_[v].push_back(found);
  }
  [[nodiscard]] bool empty() const { return at_.empty(); }
  /// Those with v among the five.
  [[nodiscard]] std::span<const FarViolation> at(Index v) const {
    if (at_.empty())
      return {};
    const auto found = at_.find(v);
    return found == at_.end() ? std::span<const FarViolation>() : found->second;
  }

private:
  std::unordered_map<Index, std::vector<FarViolation>> at_;
};

[[nodiscard]] inline FacetStar star_of(const Triangulation<3> &mesh,
                                       const FarViolation &violation) {
  FacetStar star;
  for (std::size_t k = 0; k < star.size(); ++k)
    star[k] = &mesh.vertex(violation[k]);
  return star;
}

} // namespace anistar
