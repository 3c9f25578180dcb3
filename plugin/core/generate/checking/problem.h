#pragma once
// What can be wrong with a complex.

#include "generate/plc.h"

#include <array>
#include <vector>

namespace anistar::generate {

enum class Flaw {
  out_of_range,
  repeated_point,
  empty_edge,
  repeated_edge,
  degenerate_triangle,
  repeated_triangle,
  overlap,
  crossing,
  touching,
  point_on_edge,
  point_on_facet,
  open_border,
  thin_triangle,
  near_miss,
  crowded_edge,
};
inline constexpr std::size_t n_flaws = 15;

/// One of them. What a kind has no use for is left out.
struct Problem {
  Flaw flaw;
  std::vector<Index> triangles;
  std::vector<Segment> edges;
  std::vector<Index> points;
  Vector<3> where = Vector<3>::Zero();
  double measure = 0; ///< a length: extent, height, gap; or a number of triangles
};

struct Problems {
  std::vector<Problem> listed; ///< by flaw, a few of each
  std::array<std::size_t, n_flaws> totals{};
  bool is_complete = true; ///< otherwise there is more than the totals say
};

} // namespace anistar::generate
