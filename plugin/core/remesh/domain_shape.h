#pragma once
// What the facets of a geometry mean.

#include "mesh/adjacency.h"

#include <algorithm>
#include <vector>

namespace anistar {

/// Turns by less (degrees) are round-off.
inline constexpr double round_off_turn = 1e-7;

/// The facets are samples of smooth curves and surfaces between sharp turns; or they
/// are the domain itself, and every turn is sharp; or those of one tag are planar
/// pieces of it, up to the accuracy of their points, and only given edges and changes
/// of tags are sharp.
enum class ShapeKind { smooth, polyhedron, faceted };

struct DomainShape {
  ShapeKind kind = ShapeKind::smooth;
  double ridge_angle = 45;        ///< degrees
  std::vector<Index> frozen_tags; ///< facets with these stay as they are

  [[nodiscard]] bool is_polyhedron() const { return kind == ShapeKind::polyhedron; }
  [[nodiscard]] bool is_frozen(Index facet_tag) const {
    return std::find(frozen_tags.begin(), frozen_tags.end(), facet_tag) !=
           frozen_tags.end();
  }
  [[nodiscard]] bool is_faceted() const { return kind == ShapeKind::faceted; }
  /// In degrees, of curves and surfaces. A prism that turns by just the ridge angle is
  /// sharp.
  [[nodiscard]] double sharp_turn() const {
    return kind == ShapeKind::smooth ? ridge_angle * (1 - 1e-9) : round_off_turn;
  }
};

} // namespace anistar
