#pragma once
// Which of many points lie in one sphere.

#include "generate/constrained/points/exact_points.h"

namespace anistar::generate {

/// The sphere through the vertices of a cell as D |x|^2 - N.x < 0, with bounds of the
/// errors of its coefficients; exact, and perturbed, where these leave doubts.
class SphereTest {
public:
  /// @param error bounds those of the rounded coordinates of all points asked for
  /// @pre the cell is positively oriented
  SphereTest(const ExactPoints &points, const Cell<3> &cell, double error);

  [[nodiscard]] bool contains(Index p) const;

private:
  const ExactPoints *points_;
  Cell<3> cell_;
  Vector<3> origin_, normal_;
  double leading_;
  double apart_;
  double quadratic_, linear_, constant_; ///< of the bound, in the reach of a point
};

} // namespace anistar::generate
