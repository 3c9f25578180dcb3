// Which edges, facets and tetrahedra a rule is about: those that are encroached, larger
// than the size, or badly shaped.

#include "generate/refinement/rules/rules.h"

#include <algorithm>

namespace anistar::generate {
namespace {

// How much longer than h something may be. A regular tetrahedron with edges h has a
// circumradius of .61 h, its facets one of .58 h; with these the mean edge comes near
// to h (measured; studies/generator.md).
constexpr double longest_edge = 1.33, largest_facet_radius = .8,
                 largest_cell_radius = .85;

} // namespace

bool Rules::exists(const Segment &e) {
  return mesh_.segment_of(e[0], e[1]) != none && mesh_.vertex_cell[e[0]] != none;
}

bool Rules::is_encroached(const Segment &e) {
  mesh_.cells_around(e[0], e[1], fan_);
  const Vector<3> &a = mesh_.points[e[0]], &b = mesh_.points[e[1]];
  return std::any_of(fan_.begin(), fan_.end(), [&](Index c) {
    const Cell<3> &cell = mesh_.cells[c];
    return std::any_of(cell.begin(), cell.end(), [&](Index v) {
      return v != e[0] && v != e[1] && encroaches(mesh_.points[v], a, b);
    });
  });
}

bool Rules::is_long(const Segment &e) const {
  if (!size_.is_given())
    return false;
  const Ball ball = diametral_ball(mesh_.points[e[0]], mesh_.points[e[1]]);
  return 2 * ball.radius > longest_edge * size_.at(ball.centre, e[0]);
}

Ball Rules::diametral_ball_of(HalfFacet f) const {
  const Facet<3> v = mesh_.facet(f);
  return diametral_ball(mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]]);
}

/// A point of the facet itself does not encroach upon it: it would have taken it away,
/// but for the flatness of the facet.
bool Rules::is_encroached_by(HalfFacet f, Index v) const {
  return encroaches(mesh_.points[v], diametral_ball_of(f)) &&
         !faces_.is_on(mesh_.carriers[v], mesh_.wall(f));
}

/// Of the two vertices across a wall that which encroaches upon it, the nearer one to
/// its centre if both do; none if it is spared, being across an acute angle.
Index Rules::encroaching_apex(HalfFacet f) const {
  const Ball ball = diametral_ball_of(f);
  Index found = none;
  double least = std::numeric_limits<double>::infinity();
  for (HalfFacet side : {f, mesh_.opposite(f)}) {
    if (!side.exists())
      continue;
    const Index v = mesh_.apex(side);
    const double distance = (mesh_.points[v] - ball.centre).squaredNorm();
    if (distance < least && is_encroached_by(f, v) &&
        !faces_.is_across_acute_angle(mesh_.carriers[v], mesh_.wall(f))) {
      least = distance;
      found = v;
    }
  }
  return found;
}

bool Rules::is_large(HalfFacet f) const {
  if (!size_.is_given())
    return false;
  const Ball ball = diametral_ball_of(f);
  return ball.radius > largest_facet_radius * size_.at(ball.centre, mesh_.facet(f)[0]);
}

Rules::CellShape Rules::shape_of(Index t) const {
  constexpr std::array<std::array<std::size_t, 2>, 6> pairs{
      {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
  const Cell<3> &cell = mesh_.cells[t];
  const Simplex<3> s = mesh_.simplex(t);
  double least = std::numeric_limits<double>::infinity();
  Segment shortest{none, none};
  for (const auto &[i, j] : pairs) {
    const double square = (s[i] - s[j]).squaredNorm();
    if (square < least) {
      least = square;
      shortest = {std::min(cell[i], cell[j]), std::max(cell[i], cell[j])};
    }
  }
  return {circumscribed_ball(s), std::sqrt(least), shortest};
}

bool Rules::is_large(const CellShape &shape) const {
  return size_.is_given() &&
         shape.ball.radius >
             largest_cell_radius * size_.at(shape.ball.centre, shape.shortest_edge[0]);
}

/// Queues the walls of a new cell that its vertices encroach upon, or that are large.
void Rules::consider_walls(Index c) {
  for (std::size_t i = 0; i < 4; ++i) {
    const HalfFacet f(c, i);
    const Index facet = mesh_.wall(f);
    if (facet == none)
      continue;
    const Index v = mesh_.apex(f);
    bool waits = is_large(f);
    if (!waits && is_encroached_by(f, v)) {
      if (faces_.is_across_acute_angle(mesh_.carriers[v], facet))
        ++record_.of(Refusal::acute_encroachment);
      else
        waits = true;
    }
    if (waits)
      queues_.facets.push({mesh_.facet(f), c});
  }
}

/// Queues a new cell that is large or badly shaped, or a sliver.
void Rules::consider_cell(Index c) {
  const CellShape shape = shape_of(c);
  const bool is_bad = shape.ratio() > settings_.bound;
  if (is_bad || is_large(shape))
    queues_.cells.push(mesh_, c, shape.ratio());
  else if (eliminates_slivers_ && is_sliver(c))
    queues_.slivers.push(mesh_, c, largest_dihedral_cosine(mesh_.simplex(c)));
}

} // namespace anistar::generate
