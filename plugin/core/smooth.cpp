#include "shape.h"

#include <cmath>

namespace anistar {
namespace {

/// Step of the pliant forces, the damping of the published algorithm.
constexpr double pliant_step = .2;
/// Over-relaxation is unstable where the metric varies: stop short of the circumcentres.
constexpr double odt_step = .8;
/// Longest move in the vertex's own metric.
constexpr double longest_move = .3;
/// A move may shrink a cell of the star to this fraction of its area, then is halved.
constexpr double smallest_area = .05;
constexpr int max_halvings = 4;
constexpr int flip_cap = 40;

Vector<2> pliant_displacement(const Triangulation<2> &mesh, const Vertex<2> &v,
                              std::span<const HalfFacet> star) {
  Vector<2> force = Vector<2>::Zero();
  const auto pull = [&](const Vertex<2> &neighbour) {
    const double length = edge_length(v, neighbour);
    const double fourth = length * length * length * length;
    force -= ((1 - fourth) * std::exp(-fourth) / length) * (neighbour.x - v.x);
  };
  for (HalfFacet h : star)
    pull(mesh.vertex(mesh.facet(h)[0]));
  return pliant_step * force;
}

/// Centre of the circumscribed ellipse of v, a, b in their mean metric, from v, weighted
/// by the area in that metric.
struct Weighted {
  Vector<2> sum = Vector<2>::Zero();
  double weight = 0;
};

void add_circumcentre(const Vertex<2> &v, const Vertex<2> &a, const Vertex<2> &b,
                      Weighted &mean) {
  const SymmetricTensor<2> M = v.weight * v.M + a.weight * a.M + b.weight * b.M;
  const Vector<2> p = a.x - v.x, q = b.x - v.x;
  const double area = cross(p, q), det = determinant<2>(M);
  const double pp = quadratic<2>(M, p), qq = quadratic<2>(M, q);
  const double gx = (pp * q[1] - qq * p[1]) / (2 * area);
  const double gy = (qq * p[0] - pp * q[0]) / (2 * area);
  const Vector<2> centre((M(1, 1) * gx - M(0, 1) * gy) / det,
                         (M(0, 0) * gy - M(0, 1) * gx) / det);
  const double weight = area / std::cbrt(v.weight * a.weight * b.weight);
  mean.sum += weight * centre;
  mean.weight += weight;
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

/// Whether v may go to x: every cell of its star stays positive, exactly, and does not
/// collapse.
bool may_move(const Triangulation<2> &mesh, const Vector<2> &from, const Vector<2> &x,
              std::span<const HalfFacet> star) {
  for (HalfFacet h : star) {
    const auto [ia, ib] = mesh.facet(h);
    const Vector<2> &a = mesh.vertex(ia).x, &b = mesh.vertex(ib).x;
    if (cross(a - x, b - x) <= smallest_area * cross(a - from, b - from) ||
        orientation(x, a, b) != Orientation::positive)
      return false;
  }
  return true;
}

class Smoother {
public:
  Smoother(Workspace &w, Legaliser &legaliser, Target target)
      : w_(w), legaliser_(legaliser), target_(target) {}

  void visit(Index v) {
    Triangulation<2> &mesh = w_.mesh;
    const Index feature = mesh.feature[static_cast<std::size_t>(v)];
    if (feature == Triangulation<2>::corner)
      return;
    star_of(mesh, v, star_);
    const Vertex<2> &vertex = mesh.vertex(v);
    Vector<2> step = target_ == Target::odt && feature != 1
                         ? odt_displacement(mesh, vertex, star_)
                         : pliant_displacement(mesh, vertex, star_);
    const double length = std::sqrt(quadratic<2>(vertex.M, step));
    if (length > longest_move)
      step *= longest_move / length;
    if (feature == 1 ? slide(v, step) : move(v, step)) {
      legaliser_.push_star(v);
      legaliser_.run(flip_cap);
    }
  }

private:
  Workspace &w_;
  Legaliser &legaliser_;
  Target target_;
  std::vector<HalfFacet> star_;

  bool move(Index v, Vector<2> step) {
    const Vector<2> from = w_.mesh.vertex(v).x;
    for (int halving = 0; halving < max_halvings; ++halving, step *= .5)
      if (may_move(w_.mesh, from, from + step, star_)) {
        place(v, from + step);
        return true;
      }
    return false;
  }

  void place(Index v, const Vector<2> &x) {
    Index &cell = w_.mesh.background_cell[static_cast<std::size_t>(v)];
    w_.mesh.vertex(v) = w_.background.vertex(x, cell);
  }

  /// Moves v along its curve by the part of the step that points that way. Only edges
  /// of the curve pull: the others would drive it off its spacing.
  bool slide(Index v, const Vector<2> &) {
    std::vector<HalfFacet> spokes;
    for (HalfFacet h : star_)
      for (std::size_t k = 1; k < 3; ++k) {
        const HalfFacet spoke(h.cell(), (h.facet() + k) % 3);
        if (w_.mesh.constraint(spoke) != none)
          spokes.push_back(spoke);
      }
    auto &table = w_.on_curves.curve_edges;
    CurveEdge *in = nullptr, *out = nullptr;
    for (HalfFacet spoke : spokes) {
      CurveEdge &edge = table[static_cast<std::size_t>(w_.mesh.constraint(spoke))];
      (edge.v1 == v ? in : out) = &edge;
    }
    if (!in || !out || w_.curve(*in).is_frozen)
      return false;
    const Curve &curve = w_.curve(*in);
    const Vertex<2> here = w_.mesh.vertex(v);
    const double before = edge_length(w_.mesh.vertex(in->v0), here);
    const double after = edge_length(here, w_.mesh.vertex(out->v1));
    // to equal lengths on both sides, were the metric constant
    const double t = in->t1, shift = .5 * (after - before);
    double dt = shift > 0 ? shift / after * (out->t1 - t) : shift / before * (t - in->t0);
    dt = std::clamp(dt, -.4 * (t - in->t0), .4 * (out->t1 - t));
    for (int halving = 0; halving < max_halvings; ++halving, dt *= .5) {
      const Vector<2> x = curve.at(t + dt);
      if (t + dt != t && may_move(w_.mesh, here.x, x, star_) &&
          relative_sagitta(curve, in->t0, t + dt) <= w_.hausdorff &&
          relative_sagitta(curve, t + dt, out->t1) <= w_.hausdorff) {
        in->t1 = out->t0 = t + dt;
        place(v, x);
        return true;
      }
    }
    return false;
  }
};

} // namespace

void smooth(Workspace &w, Legaliser &legaliser, Monitor &monitor, Target target) {
  Smoother smoother(w, legaliser, target);
  const auto n = static_cast<Index>(w.mesh.vertices.size());
  for (Index v = 0; v < n && monitor.keep_going(0, double(v) / n); ++v)
    if (w.mesh.is_used(v))
      smoother.visit(v);
}

} // namespace anistar
