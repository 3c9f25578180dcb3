#include "certificate/facet_test.h"

namespace anistar {
namespace {

/// What an exact answer is returned as when the rounded value has the other sign.
constexpr double barely = 1e-30;
/// The rounding error of <M, K> is below this times r^5 trace M, where r is the largest
/// distance from e: four minors of at most 6 r^3, each good to a few round-offs, times
/// squares of at most r^2 trace M, and the sums. Loose, for what it lets through has an
/// exact test behind it.
constexpr double error_bound = 1024 * detail::round_off;

/// <M, K> for a K that is stored with its off-diagonal entries doubled.
double contract(const SymmetricTensor<3> &M, const double *K) {
  const auto &m = M.entries;
  return m[0] * K[0] + m[1] * K[1] + m[2] * K[2] + m[3] * K[3] + m[4] * K[4] +
         m[5] * K[5];
}

/// The coefficients of the determinant, and those with every term positive.
struct Coefficients {
  double K[6] = {}, size[6] = {};
  double error = 0; ///< of <M, K>, for each unit of the trace of M

  [[nodiscard]] double margin(const SymmetricTensor<3> &M) const {
    const double det = contract(M, K), all = contract(M, size);
    return all > 0 ? det / all : -barely;
  }
};

Coefficients coefficients_of(const FacetStar &star) {
  const Vector<3> &e = star[4]->x;
  const Vector<3> u[4] = {star[0]->x - e, star[1]->x - e, star[2]->x - e,
                          star[3]->x - e};
  const Vector<3> front = u[0].cross(u[1]), back = u[2].cross(u[3]);
  const double minors[4] = {u[1].dot(back), -u[0].dot(back), front.dot(u[3]),
                            -front.dot(u[2])};
  Coefficients out;
  double farthest = 0;
  for (int i = 0; i < 4; ++i) {
    const double x = u[i][0], y = u[i][1], z = u[i][2], w = minors[i];
    const double squares[6] = {x * x, 2 * x * y, y * y, 2 * x * z, 2 * y * z, z * z};
    for (int k = 0; k < 6; ++k) {
      out.K[k] += w * squares[k];
      out.size[k] += std::abs(w) * squares[k];
    }
    farthest = std::max(farthest, squares[0] + squares[2] + squares[5]);
  }
  out.error = error_bound * farthest * farthest * std::sqrt(farthest);
  return out;
}

/// The sign of the determinant, when rounding could have changed it.
double decided(const SymmetricTensor<3> &M, const FacetStar &star, double margin) {
  const bool is_inside = in_metric_sphere(M, star[0]->x, star[1]->x, star[2]->x,
                                          star[3]->x, star[4]->x) == Side::inside;
  return is_inside ? std::max(margin, barely) : std::min(margin, -barely);
}

} // namespace

double facet_margin(const FacetStar &star) {
  const Coefficients facet = coefficients_of(star);
  double worst = -1;
  for (const Vertex<3> *v : star) {
    const auto &m = v->M.entries;
    const double det = contract(v->M, facet.K);
    const double size = contract(v->M, facet.size);
    const double bound = facet.error * (m[0] + m[2] + m[5]);
    if (det <= worst * size - bound)
      continue; // it does not matter
    double margin = size > 0 ? det / size : -barely;
    if (std::abs(det) <= bound || !(bound > detail::underflow_guard))
      margin = decided(v->M, star, margin);
    worst = std::max(worst, margin);
  }
  return worst;
}

/// With u_i = x_i - e, q_i = u_i.Mu_i and w_i the minors, the determinant is
/// sum_i w_i q_i: u_i stands in q_i and in the minors of the three others. What e does
/// is the opposite of what all of them do.
FacetSlope facet_slope(const FacetStar &star, std::size_t moved) {
  const Coefficients facet = coefficients_of(star);
  const Vertex<3> &worst = **std::max_element(
      star.begin(), star.end(), [&](const Vertex<3> *a, const Vertex<3> *b) {
        return facet.margin(a->M) < facet.margin(b->M);
      });
  std::array<Vector<3>, 4> u, Mu;
  std::array<double, 4> q;
  for (std::size_t i = 0; i < 4; ++i) {
    u[i] = star[i]->x - star[4]->x;
    Mu[i] = product<3>(worst.M, u[i]);
    q[i] = Mu[i].dot(u[i]);
  }
  const auto slope = [&](std::size_t i) -> Vector<3> {
    // the other three, in an order that makes the minor of i their triple product
    const std::size_t j = i ^ 1, k = i < 2 ? 2 + (i & 1) : (i & 1),
                      l = i < 2 ? 3 - (i & 1) : 1 - (i & 1);
    const Vector<3> kl = u[k].cross(u[l]), lj = u[l].cross(u[j]), jk = u[j].cross(u[k]);
    return 2 * u[j].dot(kl) * Mu[i] - q[j] * kl - q[k] * lj - q[l] * jk;
  };
  Vector<3> gradient;
  if (moved < 4)
    gradient = slope(moved);
  else
    gradient = -(slope(0) + slope(1) + slope(2) + slope(3));
  return {facet.margin(worst.M), gradient / contract(worst.M, facet.size)};
}

} // namespace anistar
