#pragma once
// Where a vertex of the mesh lies: in the interior of which face of the complex.

#include "mesh/adjacency.h"

#include <cstdint>

namespace anistar::generate {

/// The face of the complex whose relative interior holds a vertex of the mesh.
struct Carrier {
  enum class Kind : std::uint8_t { vertex, segment, facet, space };
  Kind kind = Kind::space;
  Index face = none; ///< the vertex itself, the segment, the facet

  [[nodiscard]] bool is_on_segment() const { return kind <= Kind::segment; }
  [[nodiscard]] bool is_on_facet() const { return kind <= Kind::facet; }
};

} // namespace anistar::generate
