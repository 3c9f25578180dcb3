#include "plane/mesh/cavity.h"

#include <algorithm>

namespace anistar {
namespace {

/// The vertices of a cell but those at positions i and j, in increasing order.
template <std::size_t d>
std::array<Index, d - 1> ridge_of(const Cell<d> &cell, std::size_t i, std::size_t j) {
  std::array<Index, d - 1> ridge{};
  std::size_t n = 0;
  for (std::size_t k = 0; k <= d; ++k)
    if (k != i && k != j)
      ridge[n++] = cell[k];
  std::sort(ridge.begin(), ridge.end());
  return ridge;
}

} // namespace

template <std::size_t d> void Cavity<d>::clear() {
  if (++epoch_ == 0) { // the counter wrapped: old stamps could look new
    std::fill(stamp_.begin(), stamp_.end(), 0);
    epoch_ = 1;
  }
  cells_.clear();
}

template <std::size_t d> void Cavity<d>::add(Index cell) {
  if (std::cmp_greater_equal(cell, stamp_.size()))
    stamp_.resize(mesh_.cells.size(), 0);
  if (stamp_[cell] == epoch_)
    return;
  stamp_[cell] = epoch_;
  cells_.push_back(cell);
}

template <std::size_t d>
void Cavity<d>::bound(Index apex, std::span<const HalfFacet> skipped) {
  facets_.clear();
  at_apex_.clear();
  for (Index c : cells_) {
    const std::size_t a = mesh_.local_index(c, apex);
    const bool has_apex = mesh_.at(c)[a] == apex;
    for (std::size_t i = 0; i <= d; ++i) {
      const HalfFacet h(c, i), beyond = mesh_.opposite(h);
      if (beyond.exists() && contains(beyond.cell()))
        continue;
      if (has_apex && i != a)
        at_apex_.push_back(h);
      else if (std::find(skipped.begin(), skipped.end(), h) == skipped.end())
        facets_.push_back(h);
    }
  }
}

template <std::size_t d> bool Cavity<d>::is_star_shaped(const Vector<d> &x) const {
  for (HalfFacet h : facets_) {
    Simplex<d> s = mesh_.simplex(h.cell());
    s[h.facet()] = x;
    if (!has_volume<d>(s))
      return false;
  }
  return true;
}

/// Joins a facet at the apex with its other side if that has come already. A cavity has
/// a dozen facets in 2D and some tens in 3D: a linear search is the fastest there.
template <std::size_t d> void Cavity<d>::connect(const Port &port) {
  for (Port &other : ports_)
    if (other.ridge == port.ridge) {
      mesh_.join(port.half, other.half);
      const Index constraint =
          port.constraint != none ? port.constraint : other.constraint;
      mesh_.set_constraint(port.half, constraint);
      mesh_.set_constraint(other.half, constraint);
      other = ports_.back();
      ports_.pop_back();
      return;
    }
  ports_.push_back(port);
}

template <std::size_t d>
void Cavity<d>::fill(Index apex, std::span<const RidgeConstraint<d>> ridges) {
  const auto outer_of = [&](HalfFacet h) {
    return Outer{mesh_.at(h.cell()), h.facet(), mesh_.opposite(h), mesh_.constraint(h),
                 mesh_.region[h.cell()]};
  };
  outers_.clear();
  walls_.clear();
  for (HalfFacet h : facets_)
    outers_.push_back(outer_of(h));
  for (HalfFacet h : at_apex_)
    walls_.push_back(outer_of(h));
  // the new cells take the places of the old ones: a swap touches nothing else
  for (std::size_t k = cells_.size(); k-- > outers_.size();)
    mesh_.free_cell(cells_[k]);

  star_.clear();
  ports_.clear();
  for (std::size_t k = 0; k < outers_.size(); ++k) {
    const Outer &outer = outers_[k];
    const Index c = k < cells_.size() ? cells_[k] : mesh_.add_cell(slots_);
    mesh_.at(c) = outer.cell;
    mesh_.at(c)[outer.facet] = apex;
    mesh_.region[c] = outer.region;
    mesh_.neighbours[c] = {};
    mesh_.constraints[c].fill(none);
    const HalfFacet base(c, outer.facet);
    mesh_.join(base, outer.beyond);
    mesh_.set_constraint(base, outer.constraint);
    star_.push_back(base);
    for (Index v : mesh_.at(c))
      mesh_.vertex_cell[v] = c;
  }
  for (HalfFacet base : star_)
    for (std::size_t j = 0; j <= d; ++j)
      if (j != base.facet()) {
        const auto ridge = ridge_of<d>(mesh_.at(base.cell()), base.facet(), j);
        Index constraint = none;
        for (const RidgeConstraint<d> &given : ridges)
          if (given.ridge == ridge)
            constraint = given.constraint;
        mesh_.set_constraint(HalfFacet(base.cell(), j), constraint);
        connect({ridge, HalfFacet(base.cell(), j), constraint});
      }
  for (const Outer &wall : walls_) {
    std::size_t a = 0;
    while (wall.cell[a] != apex)
      ++a;
    const auto ridge = ridge_of<d>(wall.cell, a, wall.facet);
    for (const Port &port : ports_)
      if (port.ridge == ridge) {
        const Index constraint =
            wall.constraint != none ? wall.constraint : port.constraint;
        mesh_.join(port.half, wall.beyond);
        mesh_.set_constraint(port.half, constraint);
        if (wall.beyond.exists()) // a curve may come to run along the cavity
          mesh_.set_constraint(wall.beyond, constraint);
        break;
      }
  }
}

template class Cavity<2>;
template class Cavity<3>;

} // namespace anistar
