#pragma once
// The certificate of a mesh for the metric at its vertices.

#include "certificate/certificate.h"

namespace anistar {

struct CertificateResult {
  std::vector<std::uint8_t>
      delaunay; ///< bit k: cell Delaunay in the metric of vertex k
  std::vector<std::uint8_t> simplex_ok;
  std::vector<std::uint8_t> star_ok;
  std::vector<double> distortion;  ///< largest gamma(M_v, M_w) over the edges vw at v
  std::vector<double> radius_edge; ///< largest r / e over the metrics of its vertices
  std::vector<double> sliverity;   ///< smallest (Vol / e^d)^(1/d) over the same
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
/// @param look is asked now and then; it may throw, to end the call.
/// @throws std::invalid_argument when three cells share a facet.
template <std::size_t d>
[[nodiscard]] CertificateResult certify(std::span<const Vertex<d>> vertices,
                                        std::span<const Cell<d>> cells,
                                        std::span<const Facet<d>> facets, int threads,
                                        const std::function<void()> &look);

/// For every facet of every cell 0 when it is one of `facets`, else `none`.
template <std::size_t d>
[[nodiscard]] std::vector<std::array<Index, d + 1>>
walls(std::span<const Cell<d>> cells, std::span<const Facet<d>> facets,
      std::size_t n_points);

} // namespace anistar
