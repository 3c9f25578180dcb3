#include "plane/mesh/disagreement.h"

namespace anistar {

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
