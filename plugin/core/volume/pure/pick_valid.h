#pragma once
// Pick_valid (Algorithm 3): where the refinement point of a bad simplex goes.

#include "volume/pure/rules.h"

#include <optional>

namespace anistar {

/// Differs from the paper: the number of points that are tried is bounded, and the one
/// that is hit by the fewest configurations is taken when all are hit. The size rules
/// take the first point that can be inserted, the centre of the ball. When the time is
/// up, it ends with what it has.
class PickValid {
public:
  PickValid(const StarSet &stars, const Rules &rules,
            const ConsistencyParameters &parameters, Monitor &monitor)
      : stars_(stars), rules_(rules), parameters_(parameters), monitor_(monitor) {}

  struct Picked {
    std::optional<Site> site;
    Index ball = none; ///< of a protected site that held a candidate
  };
  /// A point of the picking region of a bad simplex: the ball of radius delta r about
  /// the centre, for a facet as it lies on the surface.
  [[nodiscard]] Picked operator()(const BadSimplex &bad, CounterRandom random) const;

private:
  const StarSet &stars_;
  const Rules &rules_;
  const ConsistencyParameters &parameters_;
  Monitor &monitor_;

  /// A cell that a new site would bring, as one of its four stars sees it.
  struct NewCell {
    StarSimplex others; ///< beside the new site
    double radius;
    bool is_sliver;
  };
  [[nodiscard]] std::optional<Site> candidate(const BadSimplex &bad,
                                              const Vector<3> &x) const;
  [[nodiscard]] std::size_t hits(const Site &site, double radius) const;
  void see_from(Index w, const Site &site, std::vector<NewCell> &cells) const;
};

} // namespace anistar
