#include "plane/mesh/sliding_vertex.h"

namespace anistar {

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
