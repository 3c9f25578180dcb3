#include "plane/mesh/sliding_vertex.h"

#include <cmath>

namespace anistar {
namespace {

/// Step of the pliant forces, the damping of the published algorithm.
constexpr double pliant_step = .2;
/// Over-relaxation is unstable where the metric varies: stop short of the
/// circumcentres.
constexpr double odt_step = .8;
/// A move may shrink a cell of the star to this fraction of its area.
constexpr double smallest_area = .05;

/// Centre of the circumscribed ellipse of v, a, b in their mean metric, from v,
/// weighted by the area in that metric.
struct Weighted {
  Vector<2> sum = Vector<2>::Zero();
  double weight = 0;
};

void add_circumcentre(const Vertex<2> &v, const Vertex<2> &a, const Vertex<2> &b,
                      Weighted &mean) {
  const SymmetricTensor<2> M = v.weight * v.M + a.weight * a.M + b.weight * b.M;
  const double area = cross(a.x - v.x, b.x - v.x);
  const double weight = area / elementary::cube_root(v.weight * a.weight * b.weight);
  mean.sum += weight * circumcircle(M, v.x, a.x, b.x).offset;
  mean.weight += weight;
}

} // namespace

Vector<2> pliant_displacement(const Triangulation<2> &mesh, const Vertex<2> &v,
                              std::span<const HalfFacet> star) {
  Vector<2> force = Vector<2>::Zero();
  const auto pull = [&](const Vertex<2> &neighbour) {
    const double length = edge_length(v, neighbour);
    const double fourth = length * length * length * length;
    force -= ((1 - fourth) * elementary::exp(-fourth) / length) * (neighbour.x - v.x);
  };
  for (HalfFacet h : star)
    pull(mesh.vertex(mesh.facet(h)[0]));
  return pliant_step * force;
}

Vector<2> odt_displacement(const Triangulation<2> &mesh, const Vertex<2> &v,
                           std::span<const HalfFacet> star) {
  Weighted mean;
  for (HalfFacet h : star) {
    const auto [a, b] = mesh.facet(h);
    add_circumcentre(v, mesh.vertex(a), mesh.vertex(b), mean);
  }
  return (odt_step / mean.weight) * mean.sum;
}

bool may_move(const Triangulation<2> &mesh, const Vector<2> &from, const Vector<2> &x,
              std::span<const HalfFacet> star) {
  for (HalfFacet h : star) {
    const auto [ia, ib] = mesh.facet(h);
    const Vector<2> &a = mesh.vertex(ia).x, &b = mesh.vertex(ib).x;
    if (cross(a - x, b - x) <= smallest_area * cross(a - from, b - from) ||
        !has_volume<2>({x, a, b}))
      return false;
  }
  return true;
}

SlidingVertex::SlidingVertex(Workspace &w, std::span<const HalfFacet> star, Index v)
    : w_(w) {
  for (HalfFacet h : star)
    for (std::size_t k = 1; k < 3; ++k) {
      const HalfFacet spoke(h.cell(), (h.facet() + k) % 3);
      const Index record = w.mesh.constraint(spoke);
      if (record == none || w.curve(edge(record)).is_frozen)
        continue;
      (edge(record).v1 == v ? in_ : out_) = record;
    }
}

Vector<2> SlidingVertex::at(double dt) const { return w_.curve(in()).at(in().t1 + dt); }

bool SlidingVertex::may_slide(double dt) const {
  const Curve &curve = w_.curve(in());
  const double t = in().t1 + dt;
  return in().t0 < t && t < out().t1 &&
         relative_sagitta(curve, in().t0, t) <= w_.hausdorff &&
         relative_sagitta(curve, t, out().t1) <= w_.hausdorff && is_clear(curve.at(t));
}

bool SlidingVertex::is_clear(const Vector<2> &x) const {
  const Index before = in().v0, v = in().v1, after = out().v1;
  const Curve &curve = w_.curve(in());
  const Index replaced[2] = {in_, out_};
  const auto at = [&](Index u) -> const Vector<2> & { return w_.mesh.vertex(u).x; };
  return w_.walls.is_clear(curve, at(before), before, at(v), v, x, replaced) &&
         w_.walls.is_clear(curve, at(v), v, at(after), after, x, replaced);
}

void SlidingVertex::commit(double dt) const {
  edge(in_).t1 += dt;
  edge(out_).t0 = edge(in_).t1;
  const Vector<2> x = at(0);
  w_.walls.extend(in_, x);
  w_.walls.extend(out_, x);
}

} // namespace anistar
