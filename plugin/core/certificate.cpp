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
  // powers are those of the facet's vertices as seen from the cell that is left
  const auto cross = [&](Index from, std::size_t i, std::uint8_t depth,
                         const Power &first, const Power &second) {
    const auto k = static_cast<std::size_t>(from);
    const HalfFacet beyond = mesh_.neighbours[k][i];
    if (mesh_.constraints[k][i] == none && beyond.exists() &&
        stamp_[static_cast<std::size_t>(beyond.cell())] != epoch_)
      front_.push_back({beyond, depth, second, first});
  };
  for (std::size_t i = 0; i < 3; ++i)
    cross(cell, i, 1, {}, {});
  for (std::size_t k = 0; k < front_.size(); ++k) {
    const Front front = front_[k];
    const Index c0 = front.entry.cell();
    std::uint32_t &seen = stamp_[static_cast<std::size_t>(c0)];
    if (seen == epoch_)
      continue;
    seen = epoch_;
    reach_ = std::max(reach_, front.depth);
    const auto deeper = static_cast<std::uint8_t>(std::min(front.depth + 1, 255));
    const std::size_t i = front.entry.facet();
    const Cell<2> &far = cell_at(c0);
    const Index apex = far[i];
    const Vector<2> &e = vertex(apex);
    Power power;
    if (apex != simplex[0] && apex != simplex[1] && apex != simplex[2]) {
      power = sphere_power(M, a, b, c, e);
      if (power.value < -power.error ||
          (power.value <= power.error &&
           in_metric_sphere(M, a, b, c, e) == Side::inside))
        return apex;
    }
    // facet i is (p, q); the other two are (q, e) and (e, p)
    const Vector<2> &p = vertex(far[(i + 1) % 3]), &q = vertex(far[(i + 2) % 3]);
    if (segment_meets_sphere(M, a, b, c, q, e, front.second, power))
      cross(c0, (i + 1) % 3, deeper, front.second, power);
    if (segment_meets_sphere(M, a, b, c, e, p, power, front.first))
      cross(c0, (i + 2) % 3, deeper, power, front.first);
  }
  return none;
}

std::uint8_t DelaunayTest::bits(Index cell) {
  unsigned found = 0;
  reach_ = 0;
  for (unsigned k = 0; k < 3; ++k) {
    const Index v = mesh_.cells[static_cast<std::size_t>(cell)][k];
    if (violator(cell, mesh_.vertices[static_cast<std::size_t>(v)].M) == none)
      found |= 1u << k;
  }
  return static_cast<std::uint8_t>(found);
}

DelaunayBits delaunay_bits(CertifiedMesh<2> mesh, int threads) {
  const std::size_t n = mesh.cells.size();
  DelaunayBits found{std::vector<std::uint8_t>(n, 0), std::vector<std::uint8_t>(n, 0)};
  parallel_ranges(n, threads, [&](std::size_t begin, std::size_t end) {
    DelaunayTest test(mesh);
    for (std::size_t c = begin; c < end; ++c) {
      found.bits[c] = test.bits(static_cast<Index>(c));
      found.reach[c] = test.reach();
    }
  });
  return found;
}

} // namespace anistar
