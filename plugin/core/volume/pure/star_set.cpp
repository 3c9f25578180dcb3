#include "volume/pure/star_set.h"

#include <algorithm>

namespace anistar {
namespace {

/// Of the extent of the domain, on every side of it.
constexpr double room = .25;

void keep_each_once(std::vector<Index> &sites) {
  std::sort(sites.begin(), sites.end());
  sites.erase(std::unique(sites.begin(), sites.end()), sites.end());
}

/// The sites of the link of a star.
void add_link(const Star &star, std::vector<Index> &sites) {
  for (const Star::Seen &corner : star.corners())
    if (!Star::is_mirror(corner.site))
      sites.push_back(corner.site);
}

} // namespace

StarSet::StarSet(const DomainOracle &domain)
    : domain_(domain), enclosure_(domain.box()) {
  const Vector<3> extent =
      Vector<3>::Constant(room * (enclosure_.high - enclosure_.low).maxCoeff());
  enclosure_.low -= extent;
  enclosure_.high += extent;
}

std::vector<Index> StarSet::in_conflict(const Vector<3> &x, double weight) const {
  std::vector<Index> found;
  for (std::size_t v = 0; v < stars_.size(); ++v)
    if ((weight > 0 || boxes_[v].meets({x, x})) &&
        stars_[v].conflicts(
            stars_[v].see(static_cast<Index>(stars_.size()), x, weight)))
      found.push_back(static_cast<Index>(v));
  return found;
}

Star StarSet::star_of(const Site &site, std::span<const Index> near) const {
  const auto v = static_cast<Index>(sites_.size());
  Star star(v, site, enclosure_);
  const auto enter = [&](Index w) {
    const Site &other = sites_[w];
    star.insert(star.see(w, other.vertex.x, other.weight));
  };
  std::vector<Index> seen(near.begin(), near.end());
  std::sort(seen.begin(), seen.end(), [&](Index a, Index b) {
    const double to_a = quadratic<3>(site.vertex.M, sites_[a].vertex.x - site.vertex.x),
                 to_b = quadratic<3>(site.vertex.M, sites_[b].vertex.x - site.vertex.x);
    return to_a != to_b ? to_a < to_b : a < b;
  });
  for (Index w : seen)
    enter(w);
  std::sort(seen.begin(), seen.end());
  for (Index w = 0; w < v; ++w)
    if (((!protected_.empty() && sites_[w].is_protected()) ||
         star.balls().meets({places_[w], places_[w]})) &&
        !std::binary_search(seen.begin(), seen.end(), w))
      enter(w);
  return star;
}

std::vector<Index> StarSet::insert(const Site &site) {
  const auto v = static_cast<Index>(sites_.size());
  std::vector<Index> changed = in_conflict(site.vertex.x, site.weight);
  std::vector<Index> touched = changed;
  for (Index w : changed)
    add_link(stars_[w], touched);
  keep_each_once(touched);
  Star own = star_of(site, touched);
  for (Index w : changed)
    stars_[w].insert(stars_[w].see(v, site.vertex.x, site.weight));
  add(site, std::move(own));
  changed.push_back(v);
  for (Index w : changed) {
    restrict_to_domain(w);
    keep_boxes(w);
  }
  touched.push_back(v);
  add_link(stars_[v], touched);
  keep_each_once(touched);
  return touched;
}

void StarSet::add(const Site &site, Star &&star) {
  if (site.is_protected())
    protected_.push_back(static_cast<Index>(sites_.size()));
  sites_.push_back(site);
  places_.push_back(site.vertex.x);
  stars_.push_back(std::move(star));
  boxes_.emplace_back();
  surface_boxes_.emplace_back();
}

/// Finds what of the new triangles is in the restricted stars.
void StarSet::restrict_to_domain(Index v) {
  Star &star = stars_[v];
  Index cell = sites_[v].background;
  std::vector<LinkTriangle> &link = star.link();
  for (LinkTriangle &t : link)
    if (t.is_new)
      t.region = star.is_cell(t) ? domain_.region(t.centre, cell) : none;
  for (std::size_t k = 0; k < link.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      LinkTriangle &t = link[k], &other = link[t.across[i]];
      if (t.across[i] < k || (!t.is_new && !other.is_new))
        continue;
      SurfaceBall ball;
      if (!Star::is_mirror(star.site(t, (i + 1) % 3)) &&
          !Star::is_mirror(star.site(t, (i + 2) % 3))) {
        const auto at =
            domain_.crossing(t.centre, other.centre, star.place(), star.metric());
        ball = {at.facet, at.x, star.square_radius(at.x)};
      }
      const auto back = std::find(other.across.begin(), other.across.end(),
                                  static_cast<std::uint16_t>(k));
      t.sides[i] = ball;
      other.sides[static_cast<std::size_t>(back - other.across.begin())] = ball;
    }
  for (LinkTriangle &t : link)
    t.is_new = false;
}

void StarSet::keep_boxes(Index v) {
  boxes_[v] = stars_[v].balls();
  Box<3> &box = surface_boxes_[v];
  box = {};
  each_facet(v, [&](Index, Index, const SurfaceBall &ball) {
    const Vector<3> half =
        std::sqrt(std::max(0., ball.square_radius)) * stars_[v].extents();
    box.extend(ball.centre - half);
    box.extend(ball.centre + half);
  });
}

bool StarSet::has_cell(Index v, const StarSimplex &others, Index region) const {
  const Star &s = stars_[v];
  const auto k = s.find(others);
  return k && s.link()[*k].region == region;
}

bool StarSet::has_facet(Index v, Index a, Index b) const {
  const Star &s = stars_[v];
  for (const LinkTriangle &t : s.link())
    for (std::size_t i = 0; i < 3; ++i)
      if (t.sides[i].exists()) {
        const Index p = s.site(t, (i + 1) % 3), q = s.site(t, (i + 2) % 3);
        if ((p == a && q == b) || (p == b && q == a))
          return true;
      }
  return false;
}

Index StarSet::protected_by(const Vertex<3> &p) const {
  for (Index v : protected_) {
    const Site &site = sites_[v];
    const Vector<3> u = p.x - site.vertex.x;
    if (quadratic<3>(site.vertex.M, u) < site.weight ||
        quadratic<3>(p.M, u) < site.weight)
      return v;
  }
  return none;
}

StarSet::SurfaceFacet StarSet::encroached(const Vector<3> &x) const {
  SurfaceFacet found;
  double deepest = 0;
  for (std::size_t k = 0; k < stars_.size(); ++k) {
    if (!surface_boxes_[k].meets({x, x}))
      continue;
    const auto w = static_cast<Index>(k);
    each_facet(w, [&](Index a, Index b, const SurfaceBall &ball) {
      const double power = stars_[w].power(ball.centre, ball.square_radius, x);
      if (power < deepest * ball.square_radius) {
        deepest = power / ball.square_radius;
        found = {w, a, b, ball};
      }
    });
  }
  return found;
}

} // namespace anistar
