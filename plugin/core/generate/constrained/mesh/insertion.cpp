#include "generate/constrained/mesh/insertion.h"

#include "base/errors.h"

#include <algorithm>
#include <string>

namespace anistar::generate {

void Insertion::insert(Index p, Index start) {
  const Index c = locate(p, start);
  refuse_vertex(c, p);
  collect_cavity(p, c);
  fill_cavity(p);
}

/// Visibility walk, which ends since the mesh is Delaunay: Edelsbrunner, An acyclicity
/// theorem for cell complexes in d dimensions, 1990.
Index Insertion::locate(Index p, Index start) const {
  Index c = start;
  if (const auto i = mesh_.ghost_index(c))
    c = mesh_.opposite(HalfFacet(c, *i)).cell();
  HalfFacet entered;
  for (std::size_t step = 0; step <= mesh_.n_cells(); ++step) {
    HalfFacet next;
    for (std::size_t i = 0; i < 4 && !next.exists(); ++i) {
      const HalfFacet h(c, i);
      const auto [a, b, e] = mesh_.facet(h);
      if (h != entered && points_.orientation(a, b, e, p) == Orientation::negative)
        next = mesh_.opposite(h);
    }
    if (!next.exists())
      return c;
    if (mesh_.is_ghost(next.cell()))
      break;
    entered = next;
    c = next.cell();
  }
  throw MeshingError("a point on an edge was not found in the mesh",
                     points_.rounded(p));
}

bool Insertion::is_in_conflict(Index c, Index p) const {
  const auto i = mesh_.ghost_index(c);
  if (!i)
    return points_.is_in_sphere(mesh_.cell(c), p);
  const HalfFacet h(c, *i);
  const auto [a, b, e] = mesh_.facet(h);
  switch (points_.orientation(a, b, e, p)) {
  case Orientation::positive:
    return true;
  case Orientation::negative:
    return false;
  default: // on the plane of a facet of the hull, where circles are sections of spheres
    return points_.is_in_sphere(mesh_.cell(mesh_.opposite(h).cell()), p);
  }
}

void Insertion::refuse_vertex(Index c, Index p) const {
  for (const Index v : mesh_.cell(c))
    if (points_.compare(v, p) == 0) {
      const auto [a, b, t] = points_.steiner(p);
      throw MeshingError("point " + std::to_string(v) +
                             " lies on the edge from point " + std::to_string(a) +
                             " to point " + std::to_string(b) +
                             ", which does not end there",
                         points_.rounded(p));
    }
}

void Insertion::collect_cavity(Index p, Index start) {
  inside_.start(mesh_.n_slots());
  outside_.start(mesh_.n_slots());
  cavity_.assign(1, start);
  inside_.visit(start);
  border_.clear();
  removed_.clear();
  for (std::size_t k = 0; k < cavity_.size(); ++k) {
    removed_.push_back(mesh_.cell(cavity_[k]));
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet other = mesh_.opposite(HalfFacet(cavity_[k], i));
      const Index next = other.cell();
      if (inside_.has(next))
        continue;
      if (!outside_.has(next) && is_in_conflict(next, p)) {
        inside_.visit(next);
        cavity_.push_back(next);
      } else {
        outside_.visit(next);
        border_.push_back(other);
      }
    }
  }
}

void Insertion::fill_cavity(Index p) {
  for (const Index c : cavity_)
    mesh_.remove(c);
  open_.clear();
  for (const HalfFacet outer : border_) {
    const auto [a, b, c] = mesh_.facet(outer);
    const Index made = mesh_.add({a, c, b, p});
    mesh_.join(HalfFacet(made, 3), outer);
    for (std::size_t i = 0; i < 3; ++i)
      open_.push_back(mesh_.open_facet(HalfFacet(made, i), none));
  }
  if (!mesh_.join(open_))
    throw MeshingError("the cavity of a point is not closed", points_.rounded(p));
}

} // namespace anistar::generate
