#pragma once
// What the facets of a geometry mean.

namespace anistar {

/// Turns by less (degrees) are round-off.
inline constexpr double round_off_turn = 1e-7;

/// The facets are samples of smooth curves and surfaces between sharp turns, or they
/// are the domain itself, and every turn is sharp.
struct DomainShape {
  bool is_polyhedron = false;
  double ridge_angle = 45; ///< degrees

  /// In degrees. A prism that turns by just the ridge angle is sharp.
  [[nodiscard]] double sharp_turn() const {
    return is_polyhedron ? round_off_turn : ridge_angle * (1 - 1e-9);
  }
};

} // namespace anistar
