#include "plane/mesh/disagreement.h"

#include "certificate/circumball.h"

namespace anistar {

bool disagrees(const Triangulation<2> &mesh, HalfFacet edge) {
  const HalfFacet other = mesh.opposite(edge);
  const auto [a, b] = mesh.facet(edge);
  if (mesh.constraint(edge) != none) {
    const auto is_inside = [&](HalfFacet side) {
      return side.exists() && encroaches_on_surface(mesh.vertex(a), mesh.vertex(b),
                                                    mesh.vertex(mesh.apex(side)));
    };
    return is_inside(edge) || is_inside(other);
  }
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

bool encroaches_on_surface(const Vertex<2> &a, const Vertex<2> &b, const Vertex<2> &c) {
  const Vector<2> to_a = a.x - c.x, to_b = b.x - c.x;
  for (const Vertex<2> *v : {&a, &b}) {
    const auto &M = v->M.entries;
    const double xx = to_a[0] * to_b[0], yy = to_a[1] * to_b[1], xy = to_a[0] * to_b[1],
                 yx = to_a[1] * to_b[0];
    const double power = M[0] * xx + M[1] * (xy + yx) + M[2] * yy;
    const double size = M[0] * std::abs(xx) +
                        std::abs(M[1]) * (std::abs(xy) + std::abs(yx)) +
                        M[2] * std::abs(yy);
    const double bound = detail::sphere_bound_2 * size;
    if (power > bound && size > detail::underflow_guard)
      continue;
    if (power < -bound && size > detail::underflow_guard)
      return true;
    const SurfaceFacet<2> edge{{a.x, b.x}};
    const Circumball<2> ball(v->M, edge);
    if (ball.side(c.x, ball.power(c.x)) == Side::inside)
      return true;
  }
  return false;
}

} // namespace anistar
