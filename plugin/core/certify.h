#pragma once
// The certificate of a mesh for the metric at its vertices.

#include "certificate.h"
#include "statistics.h"

namespace anistar {

struct CertificateResult {
  std::vector<std::uint8_t>
      delaunay; ///< bit k: cell Delaunay in the metric of vertex k
  std::vector<std::uint8_t> simplex_ok;
  std::vector<std::uint8_t> star_ok;
  std::vector<double> distortion;  ///< largest gamma(M_v, M_w) over the edges vw at v
  std::vector<double> radius_edge; ///< largest r / e over the metrics of its vertices
  std::vector<std::uint8_t> exempt;
  /// Stars that pass also when the walk crosses interfaces (not the boundary).
  std::size_t stars_without_interfaces = 0;
  /// Cells whose circumcentre lies in the domain for the metric of one vertex at least
  /// (RR-7712 v2, section 3) or of all of them (v1, section 3), and how many of these
  /// are in the restricted stars of all their vertices.
  std::size_t restricted_v2 = 0, restricted_v2_ok = 0;
  std::size_t restricted_v1 = 0, restricted_v1_ok = 0;
};

/// @param facets boundary and constrained facets of the mesh, in any orientation.
/// @throws std::invalid_argument when three cells share a facet.
[[nodiscard]] CertificateResult certify(std::span<const Vertex<2>> vertices,
                                        std::span<const Cell<2>> cells,
                                        std::span<const Facet<2>> facets, int threads);

/// For every facet of every cell 0 when it is one of `facets`, else `none`.
[[nodiscard]] std::vector<std::array<Index, 3>> walls(std::span<const Cell<2>> cells,
                                                      std::span<const Facet<2>> facets,
                                                      std::size_t n_points);

} // namespace anistar
