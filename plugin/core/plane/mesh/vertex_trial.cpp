#include "plane/mesh/vertex_trial.h"

namespace anistar {
namespace {

/// What a relocation must keep, unless it was worse before.
constexpr double quality_floor = .5;
constexpr double shortest_kept = .64, longest_kept = 1.5;
/// Where the metric jumps, its interpolation may not last: no end may see much more.
constexpr double longest_kept_at_end = 2;
/// |ln l| up to here is free: a little inside the bounds of a unit edge.
const double unit_excess = elementary::log(longest_unit) - .03;
/// Lengths up to here, and from its inverse on, are: most are, and need no logarithm.
constexpr double surely_free = 1.37;

double excess(double length) {
  if (length < surely_free && length * surely_free > 1)
    return 0;
  return std::max(0., std::abs(elementary::log(length)) - unit_excess);
}

} // namespace

bool StarScore::keeps(const StarScore &before, double part) const {
  return quality >= std::min(quality_floor, part * before.quality) &&
         shortest >= std::min(shortest_kept, part * before.shortest) &&
         longest <= std::max(longest_kept, before.longest) &&
         longest_at_end <= std::max(longest_kept_at_end, before.longest_at_end);
}

int Relocation::count_disagreeing() const {
  int n = 0;
  for_each_edge([&](HalfFacet e) { n += disagrees(mesh_, e); });
  return n;
}

bool Relocation::has_excess() const {
  const Vertex<2> &v = mesh_.vertex(v_);
  return std::any_of(star_.begin(), star_.end(), [&](HalfFacet h) {
    const double l = edge_length(v, mesh_.vertex(mesh_.facet(h)[0]));
    return l < shortest_unit || l > longest_unit;
  });
}

StarScore Relocation::score() const {
  StarScore out;
  out.disagreeing = count_disagreeing();
  const Vertex<2> &v = mesh_.vertex(v_);
  const auto add_edge_to = [&](const Vertex<2> &u) {
    const Vector<2> e = u.x - v.x;
    const double lv = std::sqrt(quadratic<2>(v.M, e));
    const double lu = std::sqrt(quadratic<2>(u.M, e));
    const double l = mean_length(lv, lu);
    out.longest_at_end = std::max({out.longest_at_end, lv, lu});
    out.shortest = std::min(out.shortest, l);
    out.longest = std::max(out.longest, l);
    out.excess += excess(l);
  };
  for (HalfFacet h : star_) {
    const auto [a, b] = mesh_.facet(h);
    out.quality = std::min(out.quality, quality(v, mesh_.vertex(a), mesh_.vertex(b)));
    add_edge_to(mesh_.vertex(a));
  }
  const Index last = mesh_.facet(star_.back())[1];
  if (last != mesh_.facet(star_.front())[0]) // on the boundary the star is open
    add_edge_to(mesh_.vertex(last));
  return out;
}

bool disagrees(const Triangulation<2> &mesh, HalfFacet edge) {
  const HalfFacet other = mesh.opposite(edge);
  if (!other.exists() || mesh.constraint(edge) != none)
    return false;
  const auto [a, b] = mesh.facet(edge);
  return metrics_disagree(mesh.vertex(a), mesh.vertex(b), mesh.vertex(mesh.apex(edge)),
                          mesh.vertex(mesh.apex(other)));
}

bool metrics_disagree(const Vertex<2> &a, const Vertex<2> &b, const Vertex<2> &c,
                      const Vertex<2> &e) {
  // det = <M, K> with K = sum_i cof_i x_i x_i^T, and <|M|, S> bounds its terms
  const Vector<2> x[3] = {a.x - e.x, b.x - e.x, c.x - e.x};
  double K[3] = {0, 0, 0}, S[3] = {0, 0, 0};
  for (int i = 0; i < 3; ++i) {
    const Vector<2> &p = x[(i + 1) % 3], &q = x[(i + 2) % 3], &u = x[i];
    const double pq = p[0] * q[1], qp = p[1] * q[0];
    const double minor = pq - qp, size = std::abs(pq) + std::abs(qp);
    const double xx = u[0] * u[0], xy = 2 * u[0] * u[1], yy = u[1] * u[1];
    K[0] += minor * xx;
    K[1] += minor * xy;
    K[2] += minor * yy;
    S[0] += size * xx;
    S[1] += size * std::abs(xy);
    S[2] += size * yy;
  }
  for (const Vertex<2> *v : {&a, &b, &c, &e}) {
    const auto &M = v->M.entries;
    const double det = M[0] * K[0] + M[1] * K[1] + M[2] * K[2];
    const double bound =
        detail::sphere_bound_2 * (M[0] * S[0] + std::abs(M[1]) * S[1] + M[2] * S[2]);
    if (det > bound)
      return true;
    if (det >= -bound && in_metric_sphere(v->M, a.x, b.x, c.x, e.x) == Side::inside)
      return true;
  }
  return false;
}

} // namespace anistar
