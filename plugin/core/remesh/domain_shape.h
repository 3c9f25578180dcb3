#pragma once
// What the facets of a geometry mean.

#include "mesh/adjacency.h"

#include <algorithm>
#include <vector>

namespace anistar {

/// Turns by less (degrees) are round-off.
inline constexpr double round_off_turn = 1e-7;

/// The facets are samples of smooth curves and surfaces between sharp turns, or
/// they are the domain itself, and every turn is sharp.
enum class ShapeKind { smooth, polyhedron };

struct DomainShape {
  ShapeKind kind = ShapeKind::smooth;
  double ridge_angle = 45;        ///< degrees
  std::vector<Index> frozen_tags; ///< facets with these stay as they are

  [[nodiscard]] bool is_polyhedron() const { return kind == ShapeKind::polyhedron; }
  [[nodiscard]] bool is_frozen(Index facet_tag) const {
    return std::find(frozen_tags.begin(), frozen_tags.end(), facet_tag) !=
           frozen_tags.end();
  }
  /// In degrees. A prism that turns by just the ridge angle is sharp.
  [[nodiscard]] double sharp_turn() const {
    return is_polyhedron() ? round_off_turn : ridge_angle * (1 - 1e-9);
  }
};

} // namespace anistar
