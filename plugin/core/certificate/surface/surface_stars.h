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

/// A facet as its k-th vertex sees it.
template <std::size_t d>
[[nodiscard]] SurfaceFacet<d> surface_facet(CertifiedMesh<d> mesh,
                                            const SurfaceFacets<d> &surface,
                                            std::size_t facet, std::size_t k);

/// Bit k: the facet is in the surface star of its vertex k.
template <std::size_t d>
[[nodiscard]] std::vector<std::uint8_t> surface_bits(CertifiedMesh<d> mesh,
                                                     const SurfaceFacets<d> &surface,
                                                     int threads, const Look &look);

/// For every facet one of the cells that have it.
template <std::size_t d>
[[nodiscard]] std::vector<HalfFacet> cells_at_facets(CertifiedMesh<d> mesh,
                                                     std::size_t n_facets);

} // namespace anistar
