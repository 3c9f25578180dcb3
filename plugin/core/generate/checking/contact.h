#pragma once
// How two pieces of a complex meet beyond the points that they share, decided exactly.

#include "base/tensor.h"
#include "generate/checking/piece.h"

#include <span>
#include <vector>

namespace anistar::generate {

/// Of the worst kind, which comes last.
enum class Contact {
  none,     ///< they share points and edges, or nothing
  at_point, ///< points of one lie on the other
  along,    ///< none passes to the other side of the other
  crossing,
  overlap,  ///< triangles of one plane have more than edges in common
  repeated, ///< the same points
};

/// A point of one piece on an edge or inside of the other.
struct Landing {
  Index point;
  std::array<Index, 2> edge; ///< none: inside of the triangle
};

struct Meeting {
  Contact contact = Contact::none;
  std::vector<Landing> landings;
  Vector<3> where = Vector<3>::Zero(); ///< the middle of what they have in common
  double extent = 0;                   ///< the largest distance in it
};

/// How two pieces meet: intersections are found at their ends, which are points of one
/// on the other, edges through triangles and crossing edges.
/// @pre Triangles are not degenerate, edges not of length zero.
[[nodiscard]] Meeting meeting_of(std::span<const Vector<3>> points, const Piece &a,
                                 const Piece &b);

} // namespace anistar::generate
