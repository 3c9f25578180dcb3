#include "certificate/certificate.h"

#include "base/parallel.h"
#include "certificate/star_test.h"
#include "certificate/vertex_cells.h"

#include <algorithm>
#include <numeric>

namespace anistar {
namespace {

/// What a thread takes at once: some milliseconds.
constexpr std::size_t stars_at_once = 128;

/// Decides for some stars, on several threads.
template <std::size_t d>
void decide_stars(CertifiedMesh<d> mesh, const VertexCells<d> &cells_at,
                  std::span<const Index> stars, int threads, const Look &look,
                  DelaunayBits &known) {
  const std::size_t n = stars.size(), n_parts = (n + stars_at_once - 1) / stars_at_once;
  std::vector<std::uint8_t> passes(cells_at.size());
  StopSignal stop;
  parallel_items(n_parts, threads, [&] {
    return [&, test = StarTest<d>(mesh)](std::size_t part) mutable {
      const auto goes_on = [&] {
        return stop.goes_on([&] {
          return look(static_cast<double>(part) / static_cast<double>(n_parts));
        });
      };
      const std::size_t begin = part * stars_at_once;
      for (std::size_t k = begin; k < std::min(n, begin + stars_at_once); ++k) {
        const std::size_t v = stars[k];
        const std::span<const HalfFacet> star = cells_at.star(v);
        if ((k == begin && !goes_on()) ||
            !test.decide(stars[k], star,
                         {passes.data() + cells_at.begin(v), star.size()}, goes_on))
          return;
        known.reach[v] = test.reach();
      }
    };
  });
  if (stop.is_stopped())
    return;
  for (Index star : stars) {
    const std::size_t v = star, first = cells_at.begin(v);
    const std::span<const HalfFacet> cells = cells_at.star(v);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      std::uint8_t &bits = known.bits[cells[k].cell()];
      const unsigned bit = 1u << cells[k].facet();
      bits =
          static_cast<std::uint8_t>(passes[first + k] != 0 ? bits | bit : bits & ~bit);
    }
  }
}

/// The stars that looked as far as a changed cell, or have one.
template <std::size_t d>
std::vector<Index> dependent_stars(CertifiedMesh<d> mesh,
                                   std::span<const Index> changed,
                                   std::span<const std::uint8_t> reach) {
  std::vector<bool> is_seen(mesh.cells.size(), false);
  std::vector<bool> is_found(mesh.vertices.size(), false);
  std::vector<Index> layer, next, found;
  const auto see = [&](Index c) {
    if (is_seen[c])
      return;
    is_seen[c] = true;
    next.push_back(c);
  };
  for (Index c : changed)
    see(c);
  const int farthest =
      reach.empty() ? 0 : *std::max_element(reach.begin(), reach.end());
  for (int distance = 0; distance <= farthest && !next.empty();
       distance = std::min<int>(distance + 1, farthest_reach)) {
    layer.swap(next);
    next.clear();
    for (Index c : layer) {
      for (Index v : mesh.cells[c])
        if (reach[v] >= distance && !is_found[v]) {
          is_found[v] = true;
          found.push_back(v);
        }
      for (HalfFacet beyond : mesh.neighbours[c])
        if (beyond.exists())
          see(beyond.cell());
    }
  }
  return found;
}

} // namespace

template <std::size_t d>
DelaunayBits delaunay_bits(CertifiedMesh<d> mesh, int threads, const Look &look) {
  DelaunayBits found{PerCell<std::uint8_t>(mesh.cells.size(), 0),
                     PerVertex<std::uint8_t>(mesh.vertices.size(), 0)};
  std::vector<Index> all(mesh.vertices.size());
  std::iota(all.begin(), all.end(), 0);
  decide_stars<d>(mesh, VertexCells<d>(mesh.cells, mesh.vertices.size()), all, threads,
                  look, found);
  return found;
}

template <std::size_t d>
void renew_bits(CertifiedMesh<d> mesh, std::span<const Index> changed, int threads,
                const Look &look, DelaunayBits &known) {
  known.bits.resize(mesh.cells.size(), 0);
  known.reach.resize(mesh.vertices.size(), 0);
  decide_stars<d>(mesh, VertexCells<d>(mesh.cells, mesh.vertices.size()),
                  dependent_stars<d>(mesh, changed, known.reach), threads, look, known);
}

template DelaunayBits delaunay_bits(CertifiedMesh<2>, int, const Look &);
template void renew_bits(CertifiedMesh<2>, std::span<const Index>, int, const Look &,
                         DelaunayBits &);
template DelaunayBits delaunay_bits(CertifiedMesh<3>, int, const Look &);
template void renew_bits(CertifiedMesh<3>, std::span<const Index>, int, const Look &,
                         DelaunayBits &);

} // namespace anistar
