#include "generate/constrained/points/separation.h"

#include <algorithm>

namespace anistar::generate {
namespace {

bool is_one_of(Index v, const Facet<3> &plane) {
  return std::ranges::find(plane, v) != plane.end();
}

/// Sides of a plane on which vertices lie strictly.
struct Sides {
  bool above = false, below = false;
};

template <class Vertices>
Sides sides_of(const ExactPoints &points, const Facet<3> &plane,
               const Vertices &vertices) {
  Sides sides;
  for (const Index v : vertices)
    if (!is_one_of(v, plane)) {
      const Orientation side = points.orientation(plane[0], plane[1], plane[2], v);
      sides.above |= side == Orientation::positive;
      sides.below |= side == Orientation::negative;
    }
  return sides;
}

bool separates(const ExactPoints &points, const Facet<3> &plane, const Cell<3> &cell,
               const Facet<3> &facet) {
  const Sides one = sides_of(points, plane, cell);
  if (one.above == one.below) // both, or a plane of three points on a line
    return false;
  const Sides other = sides_of(points, plane, facet);
  return !(one.above && other.above) && !(one.below && other.below);
}

} // namespace

bool are_separated(const ExactPoints &points, const Cell<3> &cell,
                   const Facet<3> &facet) {
  for (std::size_t i = 0; i < 4; ++i)
    if (separates(points, facet_of<3>(cell, i), cell, facet))
      return true;
  const Sides round_facet = sides_of(points, facet, cell);
  if (round_facet.above != round_facet.below)
    return true;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index v = facet[k], next = facet[(k + 1) % 3];
      for (std::size_t j = i + 1; j < 4; ++j)
        if (v != cell[i] && v != cell[j] &&
            separates(points, {cell[i], cell[j], v}, cell, facet))
          return true;
      if (cell[i] != v && cell[i] != next &&
          separates(points, {cell[i], v, next}, cell, facet))
        return true;
    }
  return false;
}

} // namespace anistar::generate
