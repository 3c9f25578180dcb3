#include "plane/mesh/vertex_trial.h"

namespace anistar {
namespace {

/// What a relocation must keep, unless it was worse before.
constexpr double quality_floor = .5;
constexpr double shortest_kept = .64, longest_kept = 1.5;
/// Where the metric jumps, its interpolation may not last: no end may see much more.
constexpr double longest_kept_at_end = 2;
/// |ln l| up to here is free: a little inside the bounds of a unit edge.
constexpr double margin = .03;
const double unit_excess = elementary::log(longest_unit) - margin;
/// Lengths up to here, and from its inverse on, are: most are, and need no logarithm.
constexpr double surely_free = 1.37;

/// An edge between two cells counts for more than all edges of curves at a star:
/// between the legs of a sharp corner some of these cannot agree.
constexpr int inner_weight = 16;

/// A move may shrink a cell of the star to this fraction of its area.
constexpr double smallest_area = .05;

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

bool PlaneTrial::is_valid_at(const Vector<2> &x) const {
  return std::all_of(star_.begin(), star_.end(), [&](HalfFacet h) {
    const auto [a, b] = mesh_.facet(h);
    return has_volume<2>({x, mesh_.vertex(a).x, mesh_.vertex(b).x});
  });
}

bool PlaneTrial::may_move_to(const Vector<2> &x) const {
  const Vector<2> &from = from_.vertex.x;
  return std::all_of(star_.begin(), star_.end(), [&](HalfFacet h) {
    const auto [ia, ib] = mesh_.facet(h);
    const Vector<2> &a = mesh_.vertex(ia).x, &b = mesh_.vertex(ib).x;
    return !(cross(a - x, b - x) <= smallest_area * cross(a - from, b - from)) &&
           has_volume<2>({x, a, b});
  });
}

int PlaneTrial::count_disagreeing() const {
  int n = 0;
  for_each_edge([&](HalfFacet e) {
    const bool is_inner = mesh_.constraint(e) == none;
    if ((is_inner || edges_ == Edges::all) && disagrees(mesh_, e))
      n += is_inner ? inner_weight : 1;
  });
  return n;
}

bool PlaneTrial::has_excess() const {
  const Vertex<2> &v = mesh_.vertex(v_);
  return std::any_of(star_.begin(), star_.end(), [&](HalfFacet h) {
    const double l = edge_length(v, mesh_.vertex(mesh_.facet(h)[0]));
    return l < shortest_unit || l > longest_unit;
  });
}

StarScore PlaneTrial::score() const {
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

} // namespace anistar
