#pragma once
// Ridges as chains of segments, along which points have an order.

#include "surface/surface_features.h"

#include <map>
#include <set>

namespace anistar {

class RidgeChains {
public:
  RidgeChains() = default;
  /// @param dimension of every point of the geometry, see Features
  RidgeChains(std::span<const RidgeSegment> segments, std::span<const Index> dimension);

  /// A point on a curve, and how many segments it is from the start of it.
  struct Place {
    Index curve;
    double position;
  };
  /// The places of the point at this part of the way along a segment: a corner has one
  /// at every end of a curve there.
  [[nodiscard]] std::vector<Place> places(Index segment, double part) const;
  [[nodiscard]] bool is_closed(Index curve) const { return closed_.contains(curve); }

private:
  struct Link { ///< a segment as its chain runs through it
    Index from = none, to = none, curve = none;
    double start = 0; ///< the position of `from`
    bool is_reversed = false;
  };
  std::vector<Link> links_;
  std::map<Index, std::vector<Place>> at_corner_;
  std::set<Index> closed_; ///< curves without a corner
};

} // namespace anistar
