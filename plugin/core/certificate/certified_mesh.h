#pragma once
// A mesh as the certificate sees it.

#include "mesh/triangulation.h"

#include <array>
#include <cstdint>
#include <span>

namespace anistar {

/// An answer that looked this many cells away, or more.
inline constexpr std::uint8_t farthest_reach = 255;

template <std::size_t d> struct CertifiedMesh {
  std::span<const Vertex<d>> vertices;
  std::span<const Cell<d>> cells;
  std::span<const Neighbours<d>> neighbours;
  /// Facets whose entry is not `none` are walls and are not crossed.
  std::span<const std::array<Index, d + 1>> constraints;
};

template <std::size_t d>
[[nodiscard]] CertifiedMesh<d> certified(const Triangulation<d> &mesh) {
  return {mesh.vertices, mesh.cells, mesh.neighbours, mesh.constraints};
}

} // namespace anistar
