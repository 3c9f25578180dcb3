#include "certificate.h"

#include "parallel.h"

#include <algorithm>

namespace anistar {

Index DelaunayTest::violator(Index cell, const SymmetricTensor<2> &M) {
  const auto vertex = [&](Index v) -> const Vector<2> & {
    return mesh_.vertices[static_cast<std::size_t>(v)].x;
  };
  const auto cell_at = [&](Index c) -> const Cell<2> & {
    return mesh_.cells[static_cast<std::size_t>(c)];
  };
  const Cell<2> &simplex = cell_at(cell);
  const Vector<2> &a = vertex(simplex[0]), &b = vertex(simplex[1]),
                  &c = vertex(simplex[2]);
  if (++epoch_ == 0) {
    std::fill(stamp_.begin(), stamp_.end(), 0);
    epoch_ = 1;
  }
  stamp_[static_cast<std::size_t>(cell)] = epoch_;
  front_.clear();
  const auto cross = [&](Index from, std::size_t i) {
    const auto k = static_cast<std::size_t>(from);
    const HalfFacet beyond = mesh_.neighbours[k][i];
    if (mesh_.constraints[k][i] == none && beyond.exists() &&
        stamp_[static_cast<std::size_t>(beyond.cell())] != epoch_)
      front_.push_back(beyond);
  };
  for (std::size_t i = 0; i < 3; ++i)
    cross(cell, i);
  // the front holds facets that meet the open ball, as seen from their far cell
  for (std::size_t k = 0; k < front_.size(); ++k) {
    const HalfFacet entry = front_[k];
    std::uint32_t &seen = stamp_[static_cast<std::size_t>(entry.cell())];
    if (seen == epoch_)
      continue;
    seen = epoch_;
    const Index apex = cell_at(entry.cell())[entry.facet()];
    const bool on_ball = apex == simplex[0] || apex == simplex[1] || apex == simplex[2];
    if (!on_ball && in_metric_sphere(M, a, b, c, vertex(apex)) == Side::inside)
      return apex;
    for (std::size_t step = 1; step < 3; ++step) {
      const std::size_t i = (entry.facet() + step) % 3;
      const auto [p, q] = facet_of<2>(cell_at(entry.cell()), i);
      if (segment_meets_sphere(M, a, b, c, vertex(p), vertex(q)))
        cross(entry.cell(), i);
    }
  }
  return none;
}

std::uint8_t DelaunayTest::bits(Index cell) {
  unsigned found = 0;
  for (unsigned k = 0; k < 3; ++k) {
    const Index v = mesh_.cells[static_cast<std::size_t>(cell)][k];
    if (violator(cell, mesh_.vertices[static_cast<std::size_t>(v)].M) == none)
      found |= 1u << k;
  }
  return static_cast<std::uint8_t>(found);
}

std::vector<std::uint8_t> delaunay_bits(CertifiedMesh<2> mesh, int threads) {
  std::vector<std::uint8_t> bits(mesh.cells.size(), 0);
  parallel_ranges(mesh.cells.size(), threads, [&](std::size_t begin, std::size_t end) {
    DelaunayTest test(mesh);
    for (std::size_t c = begin; c < end; ++c)
      bits[c] = test.bits(static_cast<Index>(c));
  });
  return bits;
}

} // namespace anistar
