#pragma once
// Cells at a vertex, as it sees them.

#include "volume/mesh/volume.h"

namespace anistar {

/// The other corners of a cell at a vertex, and where they are.
struct Cone {
  std::array<Index, 3> vertices;
  std::array<Vector<3>, 3> corners;

  [[nodiscard]] bool contains(Index v) const {
    return vertices[0] == v || vertices[1] == v || vertices[2] == v;
  }
};

[[nodiscard]] Cone cone_at(const Triangulation<3> &mesh, const Cell<3> &cell,
                           Index vertex);

/// Whether the cones of two cells at one vertex have nothing in common but what their
/// common vertices span: there is a plane between them. A gap of round-off is none.
[[nodiscard]] bool are_apart(const Vector<3> &vertex, const Cone &one,
                             const Cone &other);

/// Whether a new cell at a vertex where bodies touch is apart from all that are there,
/// but for `old` ones, which go.
[[nodiscard]] bool is_apart_from_fans(const Volume &volume, Index vertex,
                                      const Cone &cone, std::span<const Index> old);

} // namespace anistar
