#pragma once
// What the caller says about the regions of a complex.

#include "base/tensor.h"
#include "mesh/adjacency.h"

#include <vector>

namespace anistar::generate {

/// What is inside, where no seed says so.
enum class RegionRule {
  parity,  ///< an odd number of walls from the outside
  nonzero, ///< the facets wind round it
  winding, ///< the same, and regions are winding numbers: nested solids are apart
};

/// The region that contains a place.
struct Seed {
  Vector<3> at;
  Index tag;
};

struct RegionChoice {
  RegionRule rule = RegionRule::parity;
  std::vector<Seed> seeds;
  std::vector<Vector<3>> holes; ///< places whose region is outside
};

} // namespace anistar::generate
