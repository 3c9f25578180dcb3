#include "certificate/surface/surface_stars.h"

#include "base/parallel.h"
#include "certificate/delaunay_test.h"

#include <cmath>

namespace anistar {
namespace {

/// What a thread takes at once: some milliseconds.
constexpr std::size_t facets_at_once = 128;

/// For every facet one of the cells that have it.
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

/// The bulge of the same facet with its k-th vertex first.
template <std::size_t d>
FacetBulge<d> bulge_from(const FacetBulge<d> &bulge, std::size_t k) {
  if constexpr (d == 3)
    return turned(bulge, k);
  else // from its other end an edge has the opposite normal
    return {k == 0 ? bulge[0] : -bulge[0]};
}

template <std::size_t d>
SurfaceFacet<d> seen_from(CertifiedMesh<d> mesh, const Facet<d> &facet,
                          const FacetBulge<d> &bulge, std::size_t k) {
  const Facet<d> vertices = turned(facet, k);
  SurfaceFacet<d> seen;
  for (std::size_t i = 0; i < d; ++i)
    seen.corners[i] = mesh.vertices[vertices[i]].x;
  seen.shift = surface_shift<d>(mesh.vertices[vertices[0]].M, seen.corners,
                                bulge_from<d>(bulge, k));
  return seen;
}

} // namespace

template <std::size_t d>
SeenFacet<d> seen_facet(CertifiedMesh<d> mesh, HalfFacet at, const Facet<d> &vertices,
                        const FacetBulge<d> &bulge) {
  SeenFacet<d> facet;
  facet.at = at;
  facet.vertices = vertices;
  for (std::size_t k = 0; k < d; ++k)
    facet.seen[k] = seen_from<d>(mesh, vertices, bulge, k);
  return facet;
}

template <std::size_t d>
std::vector<SeenFacet<d>> seen_facets(CertifiedMesh<d> mesh,
                                      const SurfaceFacets<d> &surface) {
  const std::vector<HalfFacet> cell_at =
      cells_at_facets<d>(mesh, surface.facets.size());
  std::vector<SeenFacet<d>> out;
  out.reserve(surface.facets.size());
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    if (cell_at[f].exists())
      out.push_back(
          seen_facet<d>(mesh, cell_at[f], surface.facets[f], surface.bulges[f]));
  }
  return out;
}

template <std::size_t d>
std::vector<std::array<Index, d>>
encroaching_vertices(CertifiedMesh<d> mesh, std::span<const SeenFacet<d>> facets,
                     int threads, const Look &look) {
  const std::size_t n = facets.size();
  const std::size_t n_parts = (n + facets_at_once - 1) / facets_at_once;
  std::array<Index, d> not_seen;
  not_seen.fill(no_ball);
  std::vector<std::array<Index, d>> inside(n, not_seen);
  StopSignal stop;
  parallel_items(n_parts, threads, [&] {
    return [&, test = DelaunayTest<d>(mesh)](std::size_t part) mutable {
      if (!stop.goes_on([&] {
            return look(static_cast<double>(part) / static_cast<double>(n_parts));
          }))
        return;
      const std::size_t begin = part * facets_at_once;
      for (std::size_t f = begin; f < std::min(n, begin + facets_at_once); ++f)
        for (std::size_t k = 0; k < d; ++k) {
          const SurfaceFacet<d> &seen = facets[f].seen[k];
          const std::size_t v = facets[f].vertices[k];
          inside[f][k] = std::isfinite(seen.shift)
                             ? test.violator(facets[f].at, mesh.vertices[v].M, seen)
                             : no_ball;
        }
    };
  });
  return inside;
}

template <std::size_t d>
std::vector<std::uint8_t> surface_bits(CertifiedMesh<d> mesh,
                                       const SurfaceFacets<d> &surface, int threads,
                                       const Look &look) {
  const std::vector<SeenFacet<d>> facets = seen_facets<d>(mesh, surface);
  const auto inside = encroaching_vertices<d>(mesh, facets, threads, look);
  std::vector<std::uint8_t> bits(surface.facets.size(), 0);
  for (std::size_t n = 0; n < facets.size(); ++n) {
    const auto [c, i] = std::pair(facets[n].at.cell(), facets[n].at.facet());
    for (unsigned k = 0; k < d; ++k)
      if (inside[n][k] == none)
        bits[mesh.constraints[c][i]] |= static_cast<std::uint8_t>(1u << k);
  }
  return bits;
}

template SeenFacet<2> seen_facet(CertifiedMesh<2>, HalfFacet, const Facet<2> &,
                                 const FacetBulge<2> &);
template std::vector<SeenFacet<2>> seen_facets(CertifiedMesh<2>,
                                               const SurfaceFacets<2> &);
template std::vector<std::array<Index, 2>>
encroaching_vertices(CertifiedMesh<2>, std::span<const SeenFacet<2>>, int,
                     const Look &);
template std::vector<std::uint8_t>
surface_bits(CertifiedMesh<2>, const SurfaceFacets<2> &, int, const Look &);
template SeenFacet<3> seen_facet(CertifiedMesh<3>, HalfFacet, const Facet<3> &,
                                 const FacetBulge<3> &);
template std::vector<SeenFacet<3>> seen_facets(CertifiedMesh<3>,
                                               const SurfaceFacets<3> &);
template std::vector<std::array<Index, 3>>
encroaching_vertices(CertifiedMesh<3>, std::span<const SeenFacet<3>>, int,
                     const Look &);
template std::vector<std::uint8_t>
surface_bits(CertifiedMesh<3>, const SurfaceFacets<3> &, int, const Look &);

} // namespace anistar
