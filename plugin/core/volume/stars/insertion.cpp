#include "volume/stars/insertion.h"

#include "volume/mesh/vertex_star.h"

#include <tuple>

namespace anistar {
namespace {

/// Larger cavities belong to metrics that no mesh nearby fits.
constexpr std::size_t max_cells = 96;

} // namespace

/// Whether the point will lie in the plane of a facet: it moves a vertex of it, or
/// splits an edge.
bool VolumeInsertion::holds(const Facet<3> &facet) const {
  const auto has = [&](Index v) {
    return v != none && (facet[0] == v || facet[1] == v || facet[2] == v);
  };
  return has(rule_.vertex) || (has(rule_.lost[0]) && has(rule_.lost[1]));
}

void VolumeInsertion::open() {
  const std::size_t n = volume_.mesh.cells.size();
  if (stamp_.size() < n)
    stamp_.resize(n + n / 2, 0);
  if (++epoch_ == 0) {
    std::fill(stamp_.begin(), stamp_.end(), 0);
    epoch_ = 1;
  }
}

bool VolumeInsertion::gather(const Vertex<3> &p, std::span<const Index> seeds,
                             const EntryRule &rule) {
  p_ = p;
  rule_ = rule;
  open();
  cells_.assign(seeds.begin(), seeds.end());
  for (Index c : cells_)
    stamp_[c] = epoch_;
  grow();
  if (cells_.size() > max_cells || !shrink(seeds.size()))
    return false;
  bound();
  return keeps_vertices() && keeps_ridges();
}

void VolumeInsertion::grow() {
  const Triangulation<3> &mesh = volume_.mesh;
  for (std::size_t k = 0; k < cells_.size() && cells_.size() <= max_cells; ++k)
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(cells_[k], i), beyond = mesh.opposite(h);
      if (!beyond.exists() || mesh.constraint(h) != none || contains(beyond.cell()) ||
          in_metric_sphere<3>(p_.M, mesh.simplex(beyond.cell()), p_.x) != Side::inside)
        continue;
      stamp_[beyond.cell()] = epoch_;
      cells_.push_back(beyond.cell());
    }
}

/// Gives cells back whose outer facets do not see the point well enough: where the
/// metric of the point is not that of the cells, its cavity need not be star-shaped.
bool VolumeInsertion::shrink(std::size_t n_seeds) {
  const Triangulation<3> &mesh = volume_.mesh;
  const auto sees = [&](Index c) {
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(c, i), beyond = mesh.opposite(h);
      if (beyond.exists() && contains(beyond.cell()))
        continue;
      const Facet<3> t = mesh.facet(h);
      if (!holds(t) && shape_quality(mesh.vertex(t[0]), mesh.vertex(t[1]),
                                     mesh.vertex(t[2]), p_) < quality_floor)
        return false;
    }
    return true;
  };
  for (bool changed = true; changed;) { // at most as often as there are cells
    changed = false;
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      if (sees(cells_[k]))
        continue;
      if (k < n_seeds)
        return false;
      stamp_[cells_[k]] = epoch_ - 1;
      cells_.erase(cells_.begin() + static_cast<std::ptrdiff_t>(k--));
      changed = true;
    }
  }
  return true;
}

void VolumeInsertion::bound() {
  const Triangulation<3> &mesh = volume_.mesh;
  outers_.clear();
  for (Index c : cells_)
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(c, i), beyond = mesh.opposite(h);
      if (beyond.exists() && contains(beyond.cell()))
        continue;
      if (const Facet<3> t = mesh.facet(h); !holds(t))
        outers_.push_back({h, t});
    }
}

bool VolumeInsertion::keeps_vertices() {
  link_.clear();
  volume_.open_vertices();
  if (rule_.vertex != none)
    volume_.mark_vertex(rule_.vertex);
  for (const Outer &outer : outers_)
    for (Index v : outer.v)
      if (volume_.mark_vertex(v)) {
        link_.push_back(v);
        if (quadratic<3>(p_.M, Vector<3>(volume_.mesh.vertex(v).x - p_.x)) <
            rule_.closest * rule_.closest)
          return false;
      }
  for (Index c : cells_)
    for (Index v : volume_.mesh.at(c))
      if (!volume_.is_marked_vertex(v))
        return false;
  return true;
}

/// Lines inside of regions are edges of no wall: a cavity could swallow them.
bool VolumeInsertion::keeps_ridges() const {
  for (Index c : cells_) {
    const Cell<3> &cell = volume_.mesh.at(c);
    if (!has_ridge(volume_, cell))
      continue;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (volume_.ridges.find(cell[i], cell[j]) != none && !stays(cell[i], cell[j]))
          return false;
  }
  return true;
}

/// Whether an edge of the cavity is one of its boundary too, or is to change.
bool VolumeInsertion::stays(Index a, Index b) const {
  const auto is_end = [&](Index v) { return v == a || v == b; };
  if (is_end(rule_.vertex) || (is_end(rule_.lost[0]) && is_end(rule_.lost[1])))
    return true;
  return std::any_of(outers_.begin(), outers_.end(), [&](const Outer &outer) {
    return std::count_if(outer.v.begin(), outer.v.end(), is_end) == 2;
  });
}

/// Of a facet of a surface that stays, when the cell before it has this apex.
double VolumeInsertion::wall_margin_at(const Outer &outer,
                                       const Vertex<3> &apex) const {
  const Triangulation<3> &mesh = volume_.mesh;
  const HalfFacet beyond = mesh.opposite(outer.facet);
  WallStar star = wall_star(mesh, normals_, outer.v, mesh.constraint(outer.facet),
                            {none, beyond.exists() ? mesh.apex(beyond) : none});
  star.apexes[0] = &apex;
  return margin_of(star);
}

HalfFacet VolumeInsertion::encroached() const {
  for (const Outer &outer : outers_)
    if (volume_.mesh.constraint(outer.facet) != none && wall_margin_at(outer, p_) > 0)
      return outer.facet;
  return {};
}

AgreementCost VolumeInsertion::cost_before() const {
  const Triangulation<3> &mesh = volume_.mesh;
  AgreementCost cost;
  for (Index c : cells_) {
    cost.add_cell(volume_.quality_of(c));
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(c, i), beyond = mesh.opposite(h);
      if (beyond.exists() && mesh.constraint(h) == none &&
          !(contains(beyond.cell()) && beyond.cell() < c))
        cost.add_facet(facet_margin(facet_star(mesh, h)));
    }
  }
  for (const Outer &outer : outers_)
    if (mesh.constraint(outer.facet) != none)
      cost.add_facet(wall_margin_at(outer, mesh.vertex(mesh.apex(outer.facet))));
  return cost;
}

/// Of the new cells, the facets below them and those between two of them.
AgreementCost VolumeInsertion::cost_after() {
  const Triangulation<3> &mesh = volume_.mesh;
  AgreementCost cost;
  spokes_.clear();
  for (std::size_t k = 0; k < outers_.size(); ++k) {
    const auto &[facet, t] = outers_[k];
    const Vertex<3> &a = mesh.vertex(t[0]), &b = mesh.vertex(t[1]),
                    &c = mesh.vertex(t[2]);
    cost.add_cell(shape_quality(a, b, c, p_));
    if (mesh.constraint(facet) != none)
      cost.add_facet(wall_margin_at(outers_[k], p_));
    else if (const HalfFacet beyond = mesh.opposite(facet); beyond.exists())
      cost.add_facet(facet_margin({&a, &b, &c, &p_, &mesh.vertex(mesh.apex(beyond))}));
    for (std::size_t i = 0; i < 3; ++i) {
      const Index u = t[(i + 1) % 3], w = t[(i + 2) % 3];
      spokes_.push_back({std::min(u, w), std::max(u, w), t[i], static_cast<Index>(k)});
    }
  }
  std::sort(spokes_.begin(), spokes_.end(), [](const Spoke &a, const Spoke &b) {
    return std::tie(a.low, a.high, a.base) < std::tie(b.low, b.high, b.base);
  });
  for (std::size_t k = 0; k + 1 < spokes_.size(); ++k) {
    const Spoke &one = spokes_[k], &other = spokes_[k + 1];
    if (one.low != other.low || one.high != other.high)
      continue;
    const auto &t = outers_[one.base].v;
    cost.add_facet(facet_margin({&mesh.vertex(t[0]), &mesh.vertex(t[1]),
                                 &mesh.vertex(t[2]), &p_, &mesh.vertex(other.apex)}));
  }
  return cost;
}

bool VolumeInsertion::is_sliver(const Outer &outer, double sigma_0,
                                double radius) const {
  const Simplex<3> s{volume_.mesh.vertex(outer.v[0]).x,
                     volume_.mesh.vertex(outer.v[1]).x,
                     volume_.mesh.vertex(outer.v[2]).x, p_.x};
  const double thinness =
      sliverity<3>(volume<3>(s) / p_.weight, shortest_length<3>(p_.M, s));
  return thinness < sigma_0 && circumsphere<3>(p_.M, s).radius <= radius;
}

PointScore VolumeInsertion::score(double sigma_0, double radius) {
  const AgreementCost before = cost_before(), after = cost_after();
  PointScore out{0, after.failing - before.failing, after.total() - before.total()};
  for (const Outer &outer : outers_)
    out.slivers += is_sliver(outer, sigma_0, radius);
  return out;
}

} // namespace anistar
