#include "certificate.h"

#include "parallel.h"

#include <algorithm>

namespace anistar {

template <std::size_t d> void DelaunayTest<d>::begin_walk() {
  front_.clear();
  if (++epoch_ != 0)
    return;
  std::fill(stamp_.begin(), stamp_.end(), 0);
  std::fill(known_.begin(), known_.end(), Known{});
  epoch_ = 1;
}

template <std::size_t d> void DelaunayTest<d>::cross(Index from, std::size_t i) {
  const auto k = static_cast<std::size_t>(from);
  const HalfFacet beyond = mesh_.neighbours[k][i];
  if (mesh_.constraints[k][i] == none && beyond.exists() &&
      stamp_[static_cast<std::size_t>(beyond.cell())] != epoch_)
    front_.push_back(beyond);
}

template <std::size_t d>
Index DelaunayTest<d>::violator(Index cell, const SymmetricTensor<d> &M) {
  const auto vertex = [&](Index v) -> const Vector<d> & {
    return mesh_.vertices[static_cast<std::size_t>(v)].x;
  };
  const auto cell_at = [&](Index c) -> const Cell<d> & {
    return mesh_.cells[static_cast<std::size_t>(c)];
  };
  begin_walk();
  Simplex<d> simplex;
  for (std::size_t k = 0; k <= d; ++k) {
    const Index v = cell_at(cell)[k];
    simplex[k] = vertex(v);
    known_[static_cast<std::size_t>(v)] = {epoch_, {}};
  }
  const Circumball<d> ball(M, simplex);
  stamp_[static_cast<std::size_t>(cell)] = epoch_;
  for (std::size_t i = 0; i <= d; ++i)
    cross(cell, i);
  for (std::size_t k = 0; k < front_.size(); ++k) {
    const HalfFacet entry = front_[k];
    std::uint32_t &seen = stamp_[static_cast<std::size_t>(entry.cell())];
    if (seen == epoch_)
      continue;
    seen = epoch_;
    const Cell<d> &far = cell_at(entry.cell());
    const Index apex = far[entry.facet()];
    if (Known &known = known_[static_cast<std::size_t>(apex)]; known.epoch != epoch_) {
      known = {epoch_, ball.power(vertex(apex))};
      switch (ball.side(vertex(apex), known.power)) {
      case Side::inside:
        return apex;
      case Side::boundary:
        known.power = {};
        break;
      case Side::outside:
        break;
      }
    }
    for (std::size_t i = 0; i <= d; ++i) {
      if (i == entry.facet())
        continue;
      const Facet<d> facet = facet_of<d>(far, i);
      std::array<Vector<d>, d> corners;
      std::array<Bounded, d> powers;
      for (std::size_t n = 0; n < d; ++n) {
        corners[n] = vertex(facet[n]);
        powers[n] = known_[static_cast<std::size_t>(facet[n])].power;
      }
      if (ball.meets(corners, powers))
        cross(entry.cell(), i);
    }
  }
  return none;
}

template <std::size_t d> std::uint8_t DelaunayTest<d>::bits(Index cell) {
  unsigned found = 0;
  for (unsigned k = 0; k <= d; ++k) {
    const Index v = mesh_.cells[static_cast<std::size_t>(cell)][k];
    if (violator(cell, mesh_.vertices[static_cast<std::size_t>(v)].M) == none)
      found |= 1u << k;
  }
  return static_cast<std::uint8_t>(found);
}

template <std::size_t d>
std::vector<std::uint8_t> delaunay_bits(CertifiedMesh<d> mesh, int threads) {
  std::vector<std::uint8_t> bits(mesh.cells.size(), 0);
  parallel_ranges(mesh.cells.size(), threads, [&](std::size_t begin, std::size_t end) {
    DelaunayTest<d> test(mesh);
    for (std::size_t c = begin; c < end; ++c)
      bits[c] = test.bits(static_cast<Index>(c));
  });
  return bits;
}

template class DelaunayTest<2>;
template class DelaunayTest<3>;
template std::vector<std::uint8_t> delaunay_bits(CertifiedMesh<2>, int);
template std::vector<std::uint8_t> delaunay_bits(CertifiedMesh<3>, int);

} // namespace anistar
