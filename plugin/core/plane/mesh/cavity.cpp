#include "plane/mesh/cavity.h"

#include <algorithm>

namespace anistar {
namespace {

/// The corner of a triangle that is neither i nor j.
constexpr std::size_t third(std::size_t i, std::size_t j) { return 3 - i - j; }

} // namespace

void Cavity::clear() {
  if (++epoch_ == 0) { // the counter wrapped: old stamps could look new
    std::fill(stamp_.begin(), stamp_.end(), 0);
    epoch_ = 1;
  }
  cells_.clear();
}

void Cavity::add(Index cell) {
  if (std::cmp_greater_equal(cell, stamp_.size()))
    stamp_.resize(mesh_.cells.size(), 0);
  if (stamp_[cell] == epoch_)
    return;
  stamp_[cell] = epoch_;
  cells_.push_back(cell);
}

void Cavity::bound(Index apex, std::span<const HalfFacet> skipped) {
  facets_.clear();
  at_apex_.clear();
  for (Index c : cells_) {
    const std::size_t a = mesh_.local_index(c, apex);
    const bool has_apex = mesh_.at(c)[a] == apex;
    for (std::size_t i = 0; i < 3; ++i) {
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

bool Cavity::is_star_shaped(const Vector<2> &x) const {
  for (HalfFacet h : facets_) {
    Simplex<2> s = mesh_.simplex(h.cell());
    s[h.facet()] = x;
    if (!has_volume<2>(s))
      return false;
  }
  return true;
}

bool Cavity::keeps_vertices() const {
  const auto is_kept = [&](Index v) {
    return std::any_of(facets_.begin(), facets_.end(), [&](HalfFacet h) {
      const auto [a, b] = mesh_.facet(h);
      return a == v || b == v;
    });
  };
  return std::all_of(cells_.begin(), cells_.end(), [&](Index c) {
    return std::all_of(mesh_.at(c).begin(), mesh_.at(c).end(), is_kept);
  });
}

Cavity::Outer Cavity::outer_of(HalfFacet h) const {
  return {mesh_.at(h.cell()), h.facet(), mesh_.opposite(h), mesh_.constraint(h),
          mesh_.region[h.cell()]};
}

void Cavity::fill(Index apex, std::span<const SpokeConstraint> spokes) {
  outers_.clear();
  walls_.clear();
  for (HalfFacet h : facets_)
    outers_.push_back(outer_of(h));
  for (HalfFacet h : at_apex_)
    walls_.push_back(outer_of(h));
  // the new cells take the places of the old ones: a swap touches nothing else
  for (std::size_t k = cells_.size(); k-- > outers_.size();)
    mesh_.free_cell(cells_[k]);
  make_cells(apex);
  join_cells(spokes);
  join_walls(apex);
}

void Cavity::make_cells(Index apex) {
  star_.clear();
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
}

void Cavity::join_cells(std::span<const SpokeConstraint> spokes) {
  ports_.clear();
  for (HalfFacet base : star_)
    for (std::size_t j = 0; j < 3; ++j)
      if (j != base.facet()) {
        const HalfFacet spoke(base.cell(), j);
        const Index end = mesh_.at(base.cell())[third(base.facet(), j)];
        Index constraint = none;
        for (const SpokeConstraint &given : spokes)
          if (given.end == end)
            constraint = given.constraint;
        mesh_.set_constraint(spoke, constraint);
        connect({end, spoke, constraint});
      }
}

/// Joins an edge at the apex with its other side if that has come already. A cavity has
/// a dozen facets: a linear search is the fastest there.
void Cavity::connect(const Port &port) {
  for (Port &other : ports_)
    if (other.end == port.end) {
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

/// Joins what is left with what lay beyond the edges at the apex.
void Cavity::join_walls(Index apex) {
  for (const Outer &wall : walls_) {
    std::size_t a = 0;
    while (wall.cell[a] != apex)
      ++a;
    const Index end = wall.cell[third(a, wall.facet)];
    for (const Port &port : ports_)
      if (port.end == end) {
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

} // namespace anistar
