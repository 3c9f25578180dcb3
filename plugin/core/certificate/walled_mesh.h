#pragma once
// A mesh of given arrays, ready for the certificate.

#include "certificate/certificate.h"

namespace anistar {

/// For every facet of every cell its place among `facets`, `none` when it is none of
/// them.
/// @param facets boundary and constrained facets of the mesh, in any orientation.
template <std::size_t d>
[[nodiscard]] std::vector<std::array<Index, d + 1>>
walls(std::span<const Cell<d>> cells, std::span<const Facet<d>> facets,
      std::size_t n_points);

/// Whether one of the facets lies between two cells.
template <std::size_t d>
[[nodiscard]] bool has_interfaces(std::span<const Cell<d>> cells,
                                  std::span<const Facet<d>> facets,
                                  std::size_t n_points);

/// Cells and vertices that somebody else holds, what lies beyond their facets, and
/// which of these are walls.
template <std::size_t d> class WalledMesh {
public:
  /// @param facets see walls
  /// @throws std::invalid_argument when three cells share a facet.
  WalledMesh(std::span<const Vertex<d>> vertices, std::span<const Cell<d>> cells,
             std::span<const Facet<d>> facets);

  [[nodiscard]] CertifiedMesh<d> view() const {
    return {vertices_, cells_, neighbours_, walls_};
  }
  /// Without the walls between two cells.
  void open_interfaces();

private:
  std::span<const Vertex<d>> vertices_;
  std::span<const Cell<d>> cells_;
  std::vector<Neighbours<d>> neighbours_;
  std::vector<std::array<Index, d + 1>> walls_;
};

} // namespace anistar
