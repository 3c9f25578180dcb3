#include "certificate/certificate.h"

#include "base/parallel.h"
#include "certificate/delaunay_test.h"

#include <algorithm>
#include <numeric>

namespace anistar {
namespace {

/// What a thread takes at once: some milliseconds.
constexpr std::size_t cells_at_once = 128;

} // namespace

template <std::size_t d>
void renew_bits(CertifiedMesh<d> mesh, std::span<const Index> cells, int threads,
                const Look &look, DelaunayBits &known) {
  const std::size_t n = cells.size(), n_parts = (n + cells_at_once - 1) / cells_at_once;
  StopSignal stop;
  parallel_items(n_parts, threads, [&] {
    return [&, test = DelaunayTest<d>(mesh)](std::size_t part) mutable {
      if (!stop.goes_on([&] {
            return look(static_cast<double>(part) / static_cast<double>(n_parts));
          }))
        return;
      const std::size_t begin = part * cells_at_once;
      for (std::size_t k = begin;
           !stop.is_stopped() && k < std::min(n, begin + cells_at_once); ++k) {
        const std::size_t c = cells[k];
        known.bits[c] = test.bits(cells[k]);
        known.reach[c] = test.reach();
      }
    };
  });
}

template <std::size_t d>
DelaunayBits delaunay_bits(CertifiedMesh<d> mesh, int threads, const Look &look) {
  const std::size_t n = mesh.cells.size();
  DelaunayBits found{std::vector<std::uint8_t>(n, 0), std::vector<std::uint8_t>(n, 0)};
  std::vector<Index> all(n);
  std::iota(all.begin(), all.end(), 0);
  renew_bits(mesh, all, threads, look, found);
  return found;
}

template <std::size_t d>
std::vector<Index> dependent_cells(std::span<const Neighbours<d>> neighbours,
                                   std::span<const Index> changed,
                                   std::span<const std::uint8_t> reach) {
  std::vector<bool> is_seen(neighbours.size(), false);
  std::vector<Index> layer, next, found;
  const auto see = [&](Index c) {
    if (is_seen[c])
      return;
    is_seen[c] = true;
    next.push_back(c);
  };
  for (Index c : changed)
    see(c);
  const int farthest = *std::max_element(reach.begin(), reach.end());
  for (int distance = 0; distance <= farthest && !next.empty();
       distance = std::min<int>(distance + 1, farthest_reach)) {
    layer.swap(next);
    next.clear();
    for (Index c : layer) {
      if (reach[c] >= distance)
        found.push_back(c);
      for (HalfFacet beyond : neighbours[c])
        if (beyond.exists())
          see(beyond.cell());
    }
  }
  return found;
}

template DelaunayBits delaunay_bits(CertifiedMesh<2>, int, const Look &);
template void renew_bits(CertifiedMesh<2>, std::span<const Index>, int, const Look &,
                         DelaunayBits &);
template std::vector<Index> dependent_cells<2>(std::span<const Neighbours<2>>,
                                               std::span<const Index>,
                                               std::span<const std::uint8_t>);
template DelaunayBits delaunay_bits(CertifiedMesh<3>, int, const Look &);
template void renew_bits(CertifiedMesh<3>, std::span<const Index>, int, const Look &,
                         DelaunayBits &);
template std::vector<Index> dependent_cells<3>(std::span<const Neighbours<3>>,
                                               std::span<const Index>,
                                               std::span<const std::uint8_t>);

} // namespace anistar
