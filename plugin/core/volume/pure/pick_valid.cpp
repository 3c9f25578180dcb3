#include "volume/pure/pick_valid.h"

#include "base/ellipse_sampler.h"

#include <algorithm>

namespace anistar {
namespace {

/// A point of the smooth surface is farther from the centre of a surface ball, which
/// lies on a facet of the input, than it was meant to be. It stays this far inside of
/// the ball.
constexpr double farthest_in_ball = .9;

} // namespace

PickValid::Picked PickValid::operator()(const BadSimplex &bad,
                                        CounterRandom random) const {
  const EllipseSampler<3> ellipse(stars_.star(bad.star).metric());
  Picked picked;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  for (int k = 0; k < parameters_.candidates && fewest > 0 && monitor_.keep_going();
       ++k) {
    Vector<3> x = bad.centre;
    if (k > 0)
      x += ellipse.step(parameters_.delta * bad.radius, random);
    const std::optional<Site> found = candidate(bad, x);
    if (!found)
      continue;
    if (const Index ball = stars_.protected_by(found->vertex); ball != none) {
      picked.ball = ball;
      continue;
    }
    const std::size_t n =
        is_about_size(bad.rule) ? 0 : hits(*found, parameters_.beta * bad.radius);
    if (n < fewest) {
      fewest = n;
      picked.site = found;
    }
  }
  return picked;
}

std::optional<Site> PickValid::candidate(const BadSimplex &bad,
                                         const Vector<3> &x) const {
  const DomainOracle &domain = stars_.domain();
  Site site{.background = stars_.site(bad.star).background};
  if (bad.is_facet()) {
    const Vector<3> on = domain.on_patch(bad.patch, x);
    const double allowed = farthest_in_ball * bad.radius;
    if (!(stars_.star(bad.star).power(bad.centre, allowed * allowed, on) < 0) ||
        !domain.is_on_patch(bad.patch, on))
      return std::nullopt;
    site.vertex = domain.background().vertex(on, site.background);
    site.dimension = 2;
    site.lies_on = bad.patch;
    return site;
  }
  if (domain.region(x, site.background) == none)
    return std::nullopt;
  site.vertex = domain.background().vertex(x, site.background);
  return site;
}

/// The cells of the star of w that a new site would bring.
void PickValid::see_from(Index w, const Site &site, std::vector<NewCell> &cells) const {
  const Star &star = stars_.star(w);
  const Vertex<3> &v = stars_.site(w).vertex;
  const auto p = static_cast<Index>(stars_.size());
  std::vector<std::array<Index, 2>> sides;
  star.horizon(star.see(p, site.vertex.x, site.weight), sides);
  for (const auto &[a, b] : sides) {
    if (Star::is_mirror(a) || Star::is_mirror(b))
      continue;
    const Simplex<3> s{v.x, stars_.site(a).vertex.x, stars_.site(b).vertex.x,
                       site.vertex.x};
    StarSimplex others{w, a, b};
    std::sort(others.begin(), others.end());
    cells.push_back({others, circumsphere<3>(v.M, s).radius, rules_.is_sliver(v, s)});
  }
}

/// How many slivers and inconsistent cells, no larger than this, a new site would
/// bring: its insertion is simulated.
std::size_t PickValid::hits(const Site &site, double radius) const {
  const std::vector<Index> conflict = stars_.in_conflict(site.vertex.x, site.weight);
  std::vector<NewCell> cells;
  for (Index w : conflict)
    see_from(w, site, cells);
  const Star own = stars_.star_of(site, conflict);
  for (std::size_t k = 0; k < own.link().size(); ++k)
    if (const LinkTriangle &t = own.link()[k]; own.is_cell(t)) {
      const auto corner = [&](std::size_t i) { return own.corners()[t.corners[i]].x; };
      cells.push_back({own.sorted(k), std::sqrt(std::max(0., t.square_radius)),
                       rules_.is_sliver(site.vertex, {site.vertex.x, corner(0),
                                                      corner(1), corner(2)})});
    }
  std::sort(cells.begin(), cells.end(),
            [](const NewCell &a, const NewCell &b) { return a.others < b.others; });
  std::size_t n = 0;
  for (std::size_t k = 0; k < cells.size();) {
    std::size_t next = k;
    bool is_small = false, is_sliver = false;
    for (; next < cells.size() && cells[next].others == cells[k].others; ++next) {
      is_small = is_small || cells[next].radius <= radius;
      is_sliver = is_sliver || cells[next].is_sliver;
    }
    n += is_small && (is_sliver || next - k < 4);
    k = next;
  }
  return n;
}

} // namespace anistar
