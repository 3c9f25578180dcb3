// What a cavity does to the surfaces and ridges that it contains.

#include "volume/mesh/cavity_operator.h"

#include "volume/mesh/cones.h"

namespace anistar {
namespace {

/// Relative change of volume that round-off makes where planes are kept.
constexpr double volume_tolerance = 1e-9;

} // namespace

void CavityOperator::add_surface(HalfFacet h, bool is_boundary) {
  const Triangulation<3> &mesh = volume_.mesh;
  const Facet<3> t = mesh.facet(h);
  const Vector<3> normal = (mesh.vertex(t[1]).x - mesh.vertex(t[0]).x)
                               .cross(mesh.vertex(t[2]).x - mesh.vertex(t[0]).x);
  for (std::size_t k = 0; k < 3; ++k) {
    const Index u = t[k], w = t[(k + 1) % 3];
    if (u != apex_ && w != apex_ && !is_lost(u, w))
      surface_.push_back({{u, w}, mesh.constraint(h), is_boundary, normal});
  }
}

/// Whether the new facets are on the side of the old ones, and those of curved surfaces
/// face them, or do it better than before.
bool CavityOperator::keeps_sides() const {
  const Triangulation<3> &mesh = volume_.mesh;
  const Vector<3> &x = mesh.vertex(apex_).x;
  Index patch = none;
  Vector<3> area = Vector<3>::Zero(), normal = area; ///< of the old facets, the surface
  double least = 0;                                  ///< cosine
  for (const SurfaceEdge &edge : surface_) {
    if (edge.patch != patch) {
      patch = edge.patch;
      least = volume_.surface.patch(patch).is_planar ? 0 : smallest_facet_cosine;
      area = Vector<3>::Zero();
      for (const SurfaceEdge &other : surface_)
        if (other.patch == patch) // one inside may be seen from either side
          area += !edge.is_boundary && edge.normal.dot(other.normal) < 0
                      ? Vector<3>(-other.normal)
                      : other.normal;
      normal = volume_.surface.normal(patch, x, area);
    }
    const Vector<3> &a = mesh.vertex(edge.ends[0]).x;
    const Vector<3> facet = (mesh.vertex(edge.ends[1]).x - a).cross(x - a);
    const double before = normal.dot(edge.normal) / edge.normal.norm(),
                 after = normal.dot(facet) / facet.norm();
    const bool is_turned = !edge.is_boundary && before < 0;
    if (!((is_turned ? -after : after) >
          std::min(least, edge.is_boundary ? before : std::abs(before))))
      return false;
  }
  return true;
}

/// The new facets must lie on the side of the old ones, and those of the boundary need
/// a place where the new cells end.
bool CavityOperator::add_rim(double hausdorff_number) {
  const Triangulation<3> &mesh = volume_.mesh;
  if (!keeps_sides())
    return false;
  for (const SurfaceEdge &edge : surface_) {
    const Patch &patch = volume_.surface.patch(edge.patch);
    if (patch.is_frozen)
      return false;
    if (!patch.is_planar && hausdorff_number > 0)
      for (Index end : edge.ends)
        if (volume_.surface.strays(2, edge.patch, mesh.vertex(end), mesh.vertex(apex_),
                                   hausdorff_number))
          return false;
    if (edge.is_boundary)
      outers_.push_back({{edge.ends[0], edge.ends[1], none},
                         HalfFacet(),
                         edge.patch,
                         none,
                         0,
                         Kind::rim,
                         2,
                         none});
  }
  return outers_.size() <= max_outer;
}

/// Where planes are replaced, the volume stays the same; it does by itself inside.
bool CavityOperator::keeps_shape(std::span<const Index> cells) const {
  if (surface_.empty())
    return true;
  for (const SurfaceEdge &edge : surface_)
    if (!volume_.surface.patch(edge.patch).is_planar)
      return true;
  const Triangulation<3> &mesh = volume_.mesh;
  double before = 0, after = 0;
  for (Index c : cells) {
    const Simplex<3> s = mesh.simplex(c);
    before += volume6(s[0], s[1], s[2], s[3]);
  }
  for (const Outer &outer : outers_)
    if (outer.kind == Kind::base)
      after += volume6(mesh.vertex(outer.v[0]).x, mesh.vertex(outer.v[1]).x,
                       mesh.vertex(outer.v[2]).x, mesh.vertex(apex_).x);
  return std::abs(after - before) <= volume_tolerance * before;
}

/// Where surfaces are curved their sheets may come together: a new edge at the apex
/// must not be there already, on cells outside of the cavity (the link condition).
/// Where bodies touch in the apex these are the cells of all of them.
bool CavityOperator::keeps_link() {
  const Triangulation<3> &mesh = volume_.mesh;
  const auto local = [&](Index v) { return static_cast<std::size_t>(local_of_[v]); };
  joined_.assign(local_.size(), 0);
  around_.clear();
  for (const Outer &outer : outers_) {
    if (outer.kind != Kind::at_apex)
      continue;
    for (Index v : outer.v)
      if (v != apex_)
        joined_[local(v)] = 1;
    if (outer.beyond.exists() && volume_.mark_cell(outer.beyond.cell()))
      around_.push_back(outer.beyond.cell());
  }
  const std::vector<Index> *fans = volume_.fans_of(apex_);
  if (fans)
    for (Index c : *fans)
      if (volume_.mark_cell(c))
        around_.push_back(c);
  for (std::size_t k = 0; k < around_.size(); ++k) {
    const Cell<3> &cell = mesh.at(around_[k]);
    for (std::size_t i = 0; i < 4; ++i) {
      if (cell[i] == apex_)
        continue;
      if (volume_.is_marked_vertex(cell[i]) && !joined_[local(cell[i])])
        return false;
      const HalfFacet beyond = mesh.opposite(HalfFacet(around_[k], i));
      if (beyond.exists() && volume_.mark_cell(beyond.cell()))
        around_.push_back(beyond.cell());
    }
  }
  return keeps_facets_apart();
}

/// Nor a new facet at the apex: bodies that touch along two edges must not get the one
/// between these, and a gap between two sheets that share them must not be closed.
/// @pre keeps_link has found the vertices that keep their edge to the apex.
bool CavityOperator::keeps_facets_apart() const {
  const auto is_joined = [&](Index v) { return joined_[local_of_[v]]; };
  for (const Pair &pair : pairs_) {
    const Outer &one = outers_[pair.one.outer], &other = outers_[pair.other.outer];
    if (one.kind == Kind::at_apex || other.kind == Kind::at_apex)
      continue; // it stays
    const Index u = one.v[(pair.one.slot + 1) % 3], w = one.v[(pair.one.slot + 2) % 3];
    if (!is_joined(u) || !is_joined(w))
      continue; // one of its edges is new
    for (Index c : around_) {
      const Cell<3> &cell = volume_.mesh.at(c);
      if (std::find(cell.begin(), cell.end(), u) != cell.end() &&
          std::find(cell.begin(), cell.end(), w) != cell.end())
        return false;
    }
  }
  return true;
}

/// Where a curved surface is replaced the new cells at a vertex where bodies touch
/// might lie in the other bodies.
bool CavityOperator::keeps_bodies_apart(std::span<const Index> cells) const {
  if (std::all_of(surface_.begin(), surface_.end(), [&](const SurfaceEdge &edge) {
        return volume_.surface.patch(edge.patch).is_planar;
      }))
    return true;
  const auto keeps_at = [&](Index v) {
    if (!volume_.fans_of(v))
      return true;
    for (const Outer &outer : outers_) {
      const auto &t = outer.v;
      const bool is_at = v == apex_ || std::find(t.begin(), t.end(), v) != t.end();
      if (outer.kind == Kind::base && is_at &&
          !is_apart_from_fans(
              volume_, v, cone_at(volume_.mesh, {t[0], t[1], t[2], apex_}, v), cells))
        return false;
    }
    return true;
  };
  return keeps_at(apex_) && std::all_of(local_.begin(), local_.end(), keeps_at);
}

/// Surfaces must not come together either: two sheets meet at an edge of the apex that
/// is no ridge, and as many as before at a ridge, or at the one whose place it takes.
/// Facets count twice, once per side.
/// @pre keeps_link has marked the cells around the apex.
bool CavityOperator::keeps_surface_links(std::span<const Index> cells) {
  const Triangulation<3> &mesh = volume_.mesh;
  before_.assign(local_.size(), 0);
  after_.assign(local_.size(), 0);
  const auto count = [&](std::vector<int> &counts, Index v, int n) {
    if (v != none && v != apex_ && volume_.is_marked_vertex(v))
      counts[local_of_[v]] += n;
  };
  const auto count_facets = [&](std::vector<int> &counts, Index c) {
    if (!volume_.is_walled(c))
      return;
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(c, i);
      const Facet<3> t = mesh.facet(h);
      if (mesh.constraint(h) != none && std::find(t.begin(), t.end(), apex_) != t.end())
        for (Index v : t)
          count(counts, v, mesh.opposite(h).exists() ? 1 : 2);
    }
  };
  for (Index c : around_) // outside of the cavity: the same before and after
    count_facets(after_, c);
  before_ = after_;
  for (Index c : cells)
    count_facets(before_, c);
  for (const Outer &outer : outers_)
    if (outer.kind == Kind::at_apex && outer.constraint != none)
      for (Index v : outer.v)
        count(after_, v, outer.beyond.exists() ? 1 : 2);
  for (const SurfaceEdge &edge : surface_)
    for (Index v : edge.ends)
      count(after_, v, 2);
  for (std::size_t k = 0; k < local_.size(); ++k) {
    const Index v = local_[k];
    const int wanted = is_new_ridge(v) ? sheets_at_lost(v, cells) : 4;
    if (after_[k] == before_[k] || (after_[k] == wanted && !is_ridge(apex_, v)))
      continue;
    if (after_[k] != 0 || is_ridge(apex_, v))
      return false;
  }
  return true;
}

bool CavityOperator::is_ridge(Index u, Index v) const {
  return volume_.feature(u) <= 1 && volume_.feature(v) <= 1 &&
         volume_.ridges.find(u, v) != none;
}

/// Facets of surfaces, counted once per side, at the edge of the cavity whose place the
/// one from the apex to v takes.
int CavityOperator::sheets_at_lost(Index v, std::span<const Index> cells) const {
  const Triangulation<3> &mesh = volume_.mesh;
  const Index u = lost_[0], w = lost_[1] == none ? v : lost_[1];
  int found = 0;
  for (Index c : cells)
    for (std::size_t i = 0; i < 4 && volume_.is_walled(c); ++i) {
      const HalfFacet h(c, i);
      const Facet<3> t = mesh.facet(h);
      if (mesh.constraint(h) != none && std::find(t.begin(), t.end(), u) != t.end() &&
          std::find(t.begin(), t.end(), w) != t.end())
        found += mesh.opposite(h).exists() ? 1 : 2;
    }
  return found;
}

/// Whether the edge from the apex to v takes the place of one of a ridge.
bool CavityOperator::is_new_ridge(Index v) const {
  if (lost_[0] == none || is_ridge(apex_, v))
    return false;
  if (lost_[1] == none)
    return v != lost_[0] && is_ridge(lost_[0], v);
  return (v == lost_[0] || v == lost_[1]) && is_ridge(lost_[0], lost_[1]);
}

} // namespace anistar
