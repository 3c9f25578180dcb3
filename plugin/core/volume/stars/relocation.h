#pragma once
// Moves of one vertex of a volume mesh that make the metrics around it agree.

#include "base/random.h"
#include "volume/stars/step_bounds.h"

namespace anistar {

struct RandomPlaces {
  double radius; ///< the metric distance within which they lie
  int n = 6;
};

/// Moves vertices to the best of some trial places. Moves on surfaces and ridges slide
/// along them.
class VolumeRelocation {
public:
  explicit VolumeRelocation(AgreementView &view)
      : view_(view), volume_(view.volume), vertex_(view) {}

  /// Steps that the slopes of the margins around v show, to where fewer facets fail.
  /// @returns whether there was one; if not, v is stuck until something around it
  /// changes.
  bool step(Index v);
  /// Random places for a vertex of a failing facet or a flat cell; @returns whether one
  /// is better by AgreementCost and lengths.
  bool relocate(Index v, const RandomPlaces &places, CounterRandom &random);
  /// The same for a vertex whose facets only nearly fail: then others may come nearer.
  bool make_room(Index v, const RandomPlaces &places, CounterRandom &random);
  /// A random place where no more than one more facet fails, to leave a local minimum.
  bool wander(Index v, double radius, CounterRandom &random);
  /// A step towards better shapes at which no more facets fail: straight to the ideal
  /// place, or as near to it as the facets let.
  bool polish(Index v);

  [[nodiscard]] std::size_t trials() const { return vertex_.trials(); }

private:
  AgreementView &view_;
  Volume &volume_;
  MovingVertex vertex_;
  StepBounds bounds_;

  [[nodiscard]] bool step_once();
  [[nodiscard]] bool try_all(const RandomPlaces &places, const PlaceScore &before,
                             CounterRandom &random);
  [[nodiscard]] bool polish_beside(const Vector<3> &wanted, const ShapeDemand &demand,
                                   const PlaceScore &before);
};

} // namespace anistar
