#pragma once
// The sites of a star set.

#include "mesh/measures.h"

namespace anistar {

/// A point of the mesh to be, its metric, and what of the domain it lies on.
struct Site {
  Vertex<3> vertex{};
  double weight = 0;       ///< the square of the radius of its protecting ball
  Index dimension = 3;     ///< of its feature: 0 corner, 1 ridge, 2 surface, 3 inside
  Index lies_on = none;    ///< a curve or a patch
  Index background = none; ///< where its metric was found

  [[nodiscard]] bool is_on_boundary() const { return dimension < 3; }
  [[nodiscard]] bool is_protected() const { return weight > 0; }
};

} // namespace anistar
