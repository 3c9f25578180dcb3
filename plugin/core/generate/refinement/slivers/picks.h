#pragma once
// Points of a refinement region (c, delta r): a ball of the dimension of what is
// refined.

#include "base/random.h"
#include "base/tensor.h"

#include <cstdint>

namespace anistar::generate {

/// How points are picked in a refinement region, and what they must avoid.
struct PickRule {
  double delta;             ///< radius of the region, as a fraction
  int n_picks;              ///< at most
  bool must_avoid_slivers;  ///< small ones
  double sliver_cosine = 1; ///< of the least dihedral angle
  double C = 0;             ///< small slivers have a circumradius of at most C r_tau
};

/// Offsets in the unit ball, in units of delta r: the centre first.
class Picks {
public:
  Picks(const PickRule &rule, std::uint64_t seed, std::int32_t item)
      : rule_(rule), random_({seed}, Stream::refinement_region, item, 0) {}

  [[nodiscard]] bool has_next() const { return n_ < rule_.n_picks; }
  /// @param dimension of the ball; coordinates beyond are 0
  [[nodiscard]] Vector<3> next(int dimension) {
    Vector<3> offset(0, 0, 0);
    if (n_++ == 0)
      return offset;
    constexpr int most_draws = 100; // half of them fall into the ball
    for (int draw = 0; draw < most_draws; ++draw) {
      for (int k = 0; k < dimension; ++k)
        offset[k] = 2 * random_.uniform() - 1;
      if (offset.squaredNorm() <= 1)
        break;
    }
    return offset * rule_.delta;
  }

private:
  const PickRule &rule_;
  CounterRandom random_;
  int n_ = 0;
};

} // namespace anistar::generate
