#include "certificate/delaunay_test.h"

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

template <std::size_t d>
HalfFacet DelaunayTest<d>::door(Index from, std::size_t i) const {
  const std::size_t k = from;
  const HalfFacet beyond = mesh_.neighbours[k][i];
  const bool is_open = mesh_.constraints[k][i] == none && beyond.exists() &&
                       stamp_[beyond.cell()] != epoch_;
  return is_open ? beyond : HalfFacet();
}

template <std::size_t d>
void DelaunayTest<d>::enter(HalfFacet door, std::uint8_t depth) {
  stamp_[door.cell()] = epoch_;
  front_.push_back({door, depth});
}

template <std::size_t d>
Side DelaunayTest<d>::side(const Circumball<d> &ball, Index v) {
  Known &known = known_[v];
  if (known.epoch == epoch_)
    return Side::outside; // of the simplex, or seen before
  const Vector<d> &x = mesh_.vertices[v].x;
  known = {epoch_, ball.power(x)};
  const Side found = ball.side(x, known.power);
  if (found == Side::boundary)
    known.power = {};
  return found;
}

template <std::size_t d>
bool DelaunayTest<d>::meets(const Circumball<d> &ball, const Facet<d> &facet) const {
  std::array<const Vector<d> *, d> corners;
  std::array<Bounded, d> powers;
  for (std::size_t n = 0; n < d; ++n) {
    const std::size_t v = facet[n];
    corners[n] = &mesh_.vertices[v].x;
    powers[n] = known_[v].power;
  }
  return ball.meets(corners, powers);
}

template <std::size_t d>
Index DelaunayTest<d>::violator(Index cell, const SymmetricTensor<d> &M) {
  begin_walk();
  Simplex<d> simplex;
  for (std::size_t k = 0; k <= d; ++k) {
    const std::size_t v = mesh_.cells[cell][k];
    simplex[k] = mesh_.vertices[v].x;
    known_[v] = {epoch_, {}};
  }
  const Circumball<d> ball(M, simplex);
  stamp_[cell] = epoch_;
  for (std::size_t i = 0; i <= d; ++i)
    if (const HalfFacet beyond = door(cell, i); beyond.exists())
      enter(beyond, 1);
  return walk(ball);
}

template <std::size_t d>
Index DelaunayTest<d>::violator(HalfFacet facet, const SymmetricTensor<d> &M,
                                const SurfaceFacet<d> &seen) {
  begin_walk();
  const std::size_t c = facet.cell();
  for (Index v : facet_of<d>(mesh_.cells[c], facet.facet()))
    known_[v] = {epoch_, {}};
  enter(facet, 0);
  if (const HalfFacet beyond = mesh_.neighbours[c][facet.facet()]; beyond.exists())
    enter(beyond, 0);
  return walk(Circumball<d>(M, seen));
}

/// From the facets that have been entered to a vertex inside, or to the end.
template <std::size_t d> Index DelaunayTest<d>::walk(const Circumball<d> &ball) {
  const auto cell_at = [&](Index c) -> const Cell<d> & { return mesh_.cells[c]; };
  reach_ = 0;
  for (std::size_t k = 0; k < front_.size(); ++k) {
    const auto [entry, depth] = front_[k];
    reach_ = std::max(reach_, depth);
    const auto deeper =
        static_cast<std::uint8_t>(std::min<int>(depth + 1, farthest_reach));
    const Cell<d> &far = cell_at(entry.cell());
    const Index apex = far[entry.facet()];
    if (side(ball, apex) == Side::inside)
      return apex;
    for (std::size_t i = 0; i <= d; ++i)
      if (const HalfFacet beyond = door(entry.cell(), i);
          beyond.exists() && meets(ball, facet_of<d>(far, i)))
        enter(beyond, deeper);
  }
  return none;
}

template <std::size_t d> std::uint8_t DelaunayTest<d>::bits(Index cell) {
  unsigned found = 0;
  for (unsigned k = 0; k <= d; ++k) {
    const std::size_t v = mesh_.cells[cell][k];
    if (violator(cell, mesh_.vertices[v].M) == none)
      found |= 1u << k;
  }
  return static_cast<std::uint8_t>(found);
}

template class DelaunayTest<2>;
template class DelaunayTest<3>;

} // namespace anistar
