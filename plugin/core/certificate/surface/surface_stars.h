#pragma once
// Which facets of the surfaces of a mesh are in the surface stars of their vertices.
//
// A facet t is in the surface star of its vertex v when no vertex that it can reach
// lies strictly inside its surface ball in the metric of v (surface_facet.h). Reach:
// from the cells on both sides of t along mesh cells that meet the open ball, never
// across another boundary facet or constrained facet; ties pass.

#include "certificate/certificate.h"
#include "certificate/surface/facet_bulge.h"
#include "certificate/surface/surface_facet.h"

namespace anistar {

/// Facets of a mesh, and how the surfaces that they sample bulge over them. The
/// constraints of the mesh are their places in these arrays.
template <std::size_t d> struct SurfaceFacets {
  std::span<const Facet<d>> facets;
  std::span<const FacetBulge<d>> bulges;
};

/// A facet as each of its vertices sees it.
template <std::size_t d> struct SeenFacet {
  HalfFacet at; ///< one of its sides
  Facet<d> vertices;
  std::array<SurfaceFacet<d>, d> seen; ///< by each of them
};

template <std::size_t d>
[[nodiscard]] SeenFacet<d> seen_facet(CertifiedMesh<d> mesh, HalfFacet at,
                                      const Facet<d> &vertices,
                                      const FacetBulge<d> &bulge);

/// The facets of a mesh, without those that are of no cell.
template <std::size_t d>
[[nodiscard]] std::vector<SeenFacet<d>> seen_facets(CertifiedMesh<d> mesh,
                                                    const SurfaceFacets<d> &surface);

/// No ball of a vertex goes through the facet.
inline constexpr Index no_ball = -2;

/// For every facet and each of its vertices the first vertex found inside of its
/// surface ball, `none` where the facet is in the surface star, or `no_ball`, also
/// where the look has ended the work.
template <std::size_t d>
[[nodiscard]] std::vector<std::array<Index, d>>
encroaching_vertices(CertifiedMesh<d> mesh, std::span<const SeenFacet<d>> facets,
                     int threads, const Look &look);

/// Bit k: the facet is in the surface star of its vertex k.
template <std::size_t d>
[[nodiscard]] std::vector<std::uint8_t> surface_bits(CertifiedMesh<d> mesh,
                                                     const SurfaceFacets<d> &surface,
                                                     int threads, const Look &look);

} // namespace anistar
