#include "volume/pure/rules.h"

#include "metric/bounded_distortion.h"

#include <algorithm>

namespace anistar {
namespace {

/// The other vertices of a simplex seen from one of its three others.
StarSimplex seen_from(const StarSimplex &others, std::size_t k, Index v) {
  StarSimplex seen = others;
  seen[k] = v;
  std::sort(seen.begin(), seen.end());
  return seen;
}

} // namespace

double Rules::size_at(const Vector<3> &x, Index hint) const {
  if (std::isinf(parameters_.gamma_0))
    return 1;
  const Background<3> &background = stars_.domain().background();
  const Vertex<3> centre = background.vertex(x, hint);
  return std::min(
      1., bounded_distortion_radius<3>(background, centre, hint, parameters_.gamma_0));
}

/// Whether the surface is farther from the facet, at the centre of its ball, than the
/// Hausdorff number allows.
bool Rules::strays(Index v, Index a, Index b, const SurfaceBall &ball) const {
  const Index patch = stars_.domain().facet(ball.facet).patch;
  if (stars_.domain().shape().is_flat(2, patch))
    return false;
  const Vector<3> &x = stars_.site(v).vertex.x, e = stars_.site(a).vertex.x - x,
                  f = stars_.site(b).vertex.x - x;
  const Vector<3> normal = e.cross(f).normalized();
  const double away =
      std::abs(normal.dot(stars_.domain().on_patch(patch, ball.centre) - x));
  const double longest =
      std::sqrt(std::max({e.squaredNorm(), f.squaredNorm(), (f - e).squaredNorm()}));
  return away > hausdorff_.surface * longest;
}

BadSimplex Rules::judge(Index v, Index a, Index b, const SurfaceBall &ball) const {
  const Site &site = stars_.site(v);
  const SymmetricTensor<3> &M = site.vertex.M;
  BadSimplex found{.star = v,
                   .others = {none, std::min(a, b), std::max(a, b)},
                   .centre = ball.centre,
                   .radius = std::sqrt(std::max(0., ball.square_radius)),
                   .patch = stars_.domain().facet(ball.facet).patch};
  const Vector<3> &x = site.vertex.x, &y = stars_.site(a).vertex.x,
                  &z = stars_.site(b).vertex.x;
  const double shortest = std::sqrt(std::min(
      {quadratic<3>(M, y - x), quadratic<3>(M, z - x), quadratic<3>(M, z - y)}));
  const auto is_inside = [&](Index w) { return !stars_.site(w).is_on_boundary(); };
  if (found.radius >= parameters_.alpha_1 * size_at(ball.centre, site.background) ||
      strays(v, a, b, ball))
    found.rule = Rule::facet_size;
  else if (is_inside(v) || is_inside(a) || is_inside(b))
    found.rule = Rule::facet_topology;
  else if (found.radius > parameters_.rho_0 * shortest)
    found.rule = Rule::facet_radius_edge;
  else if (!stars_.has_facet(a, v, b) || !stars_.has_facet(b, v, a))
    found.rule = Rule::facet_inconsistency;
  return found;
}

bool Rules::is_sliver(const Vertex<3> &v, const Simplex<3> &s) const {
  return sliverity<3>(volume<3>(s) / v.weight, shortest_length<3>(v.M, s)) <
         parameters_.sigma_0;
}

BadSimplex Rules::judge(Index v, const LinkTriangle &t,
                        const StarSimplex &others) const {
  const Site &site = stars_.site(v);
  const Star &star = stars_.star(v);
  const auto corner = [&](std::size_t k) { return star.corners()[t.corners[k]].x; };
  const Simplex<3> s{site.vertex.x, corner(0), corner(1), corner(2)};
  BadSimplex found{.star = v,
                   .others = others,
                   .centre = t.centre,
                   .radius = std::sqrt(std::max(0., t.square_radius))};
  const double shortest = shortest_length<3>(site.vertex.M, s);
  if (found.radius >= parameters_.alpha_0 * size_at(t.centre, site.background))
    found.rule = Rule::size;
  else if (found.radius > parameters_.rho_0 * shortest)
    found.rule = Rule::radius_edge;
  else if (is_sliver(site.vertex, s))
    found.rule = Rule::sliver;
  else if (!is_consistent(v, t, others))
    found.rule = Rule::inconsistency;
  return found;
}

bool Rules::is_consistent(Index v, const LinkTriangle &t,
                          const StarSimplex &others) const {
  for (std::size_t k = 0; k < 3; ++k)
    if (!stars_.has_cell(others[k], seen_from(others, k, v), t.region))
      return false;
  return true;
}

} // namespace anistar
