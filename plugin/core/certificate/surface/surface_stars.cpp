#include "certificate/surface/surface_stars.h"

#include "base/parallel.h"
#include "certificate/delaunay_test.h"

#include <cmath>

namespace anistar {
namespace {

/// What a thread takes at once: some milliseconds.
constexpr std::size_t facets_at_once = 128;

} // namespace

template <std::size_t d>
std::vector<HalfFacet> cells_at_facets(CertifiedMesh<d> mesh, std::size_t n_facets) {
  std::vector<HalfFacet> out(n_facets);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (std::size_t i = 0; i <= d; ++i)
      if (const Index facet = mesh.constraints[c][i];
          facet != none && !out[facet].exists())
        out[facet] = HalfFacet(static_cast<Index>(c), i);
  return out;
}

template <std::size_t d>
SurfaceFacet<d> surface_facet(CertifiedMesh<d> mesh, const SurfaceFacets<d> &surface,
                              std::size_t facet, std::size_t k) {
  const Facet<d> vertices = turned(surface.facets[facet], k);
  SurfaceFacet<d> seen;
  for (std::size_t i = 0; i < d; ++i)
    seen.corners[i] = mesh.vertices[vertices[i]].x;
  FacetBulge<d> bulge = surface.bulges[facet];
  if constexpr (d == 3)
    bulge = turned(bulge, k);
  else if (k == 1) // seen from its other end, the facet has the opposite normal
    bulge[0] = -bulge[0];
  seen.shift = surface_shift<d>(mesh.vertices[vertices[0]].M, seen.corners, bulge);
  return seen;
}

template <std::size_t d>
std::vector<std::uint8_t> surface_bits(CertifiedMesh<d> mesh,
                                       const SurfaceFacets<d> &surface, int threads,
                                       const Look &look) {
  const std::size_t n = surface.facets.size();
  const std::size_t n_parts = (n + facets_at_once - 1) / facets_at_once;
  const std::vector<HalfFacet> cell_at = cells_at_facets<d>(mesh, n);
  std::vector<std::uint8_t> bits(n, 0);
  StopSignal stop;
  parallel_items(n_parts, threads, [&] {
    return [&, test = DelaunayTest<d>(mesh)](std::size_t part) mutable {
      if (!stop.goes_on([&] {
            return look(static_cast<double>(part) / static_cast<double>(n_parts));
          }))
        return;
      const std::size_t begin = part * facets_at_once;
      for (std::size_t f = begin; f < std::min(n, begin + facets_at_once); ++f)
        for (unsigned k = 0; cell_at[f].exists() && k < d; ++k) {
          const SurfaceFacet<d> seen = surface_facet<d>(mesh, surface, f, k);
          if (std::isfinite(seen.shift) &&
              test.violator(cell_at[f], mesh.vertices[surface.facets[f][k]].M, seen) ==
                  none)
            bits[f] |= static_cast<std::uint8_t>(1u << k);
        }
    };
  });
  return bits;
}

template std::vector<HalfFacet> cells_at_facets(CertifiedMesh<2>, std::size_t);
template SurfaceFacet<2> surface_facet(CertifiedMesh<2>, const SurfaceFacets<2> &,
                                       std::size_t, std::size_t);
template std::vector<std::uint8_t>
surface_bits(CertifiedMesh<2>, const SurfaceFacets<2> &, int, const Look &);
template std::vector<HalfFacet> cells_at_facets(CertifiedMesh<3>, std::size_t);
template SurfaceFacet<3> surface_facet(CertifiedMesh<3>, const SurfaceFacets<3> &,
                                       std::size_t, std::size_t);
template std::vector<std::uint8_t>
surface_bits(CertifiedMesh<3>, const SurfaceFacets<3> &, int, const Look &);

} // namespace anistar
