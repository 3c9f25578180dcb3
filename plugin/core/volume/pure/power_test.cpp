#include "volume/pure/power_test.h"

#include "base/range.h"

#include <CGAL/Gmpzf.h>

#include <algorithm>
#include <numeric>

namespace anistar {
namespace {

using Exact = CGAL::Gmpzf;
using Row = std::array<Exact, 3>;

Row difference(const Vector<3> &x, const Vector<3> &origin) {
  require_finite(x);
  require_finite(origin);
  return {Exact(x[0]) - Exact(origin[0]), Exact(x[1]) - Exact(origin[1]),
          Exact(x[2]) - Exact(origin[2])};
}

Exact determinant(const Row &u, const Row &v, const Row &w) {
  return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
         u[2] * (v[0] * w[1] - v[1] * w[0]);
}

Exact square(const SymmetricTensor<3> &M, const Row &u) {
  Exact sum(0);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      sum += Exact(M(i, j)) * u[i] * u[j];
  return sum;
}

} // namespace

Vector<3> exact_centre(const SymmetricTensor<3> &M,
                       const std::array<WeightedPoint, 4> &cell) {
  require_finite(M.entries);
  std::array<Row, 3> u;
  for (std::size_t k = 0; k < 3; ++k)
    u[k] = difference(cell[k + 1].x, cell[0].x);
  const double det = CGAL::to_double(determinant(u[0], u[1], u[2]));
  // M (centre - v) = g with 2 g.u = |u|^2 and the weights, for the three corners
  Row sum{Exact(0), Exact(0), Exact(0)};
  for (std::size_t k = 0; k < 3; ++k) {
    const Row &p = u[(k + 1) % 3], &q = u[(k + 2) % 3];
    const Exact lift =
        square(M, u[k]) + Exact(cell[0].weight) - Exact(cell[k + 1].weight);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, l = (i + 2) % 3;
      sum[i] += lift * (p[j] * q[l] - p[l] * q[j]);
    }
  }
  const Vector<3> g = Vector<3>(CGAL::to_double(sum[0]), CGAL::to_double(sum[1]),
                                CGAL::to_double(sum[2])) /
                      (2 * det);
  const Matrix<3> L = lower_factor<3>(M);
  const Vector<3> y = L.triangularView<Eigen::Lower>().solve(g);
  return cell[0].x + L.transpose().triangularView<Eigen::Upper>().solve(y);
}

Side exact_power_side(const SymmetricTensor<3> &M, const PowerTest &test) {
  require_finite(M.entries);
  std::array<Row, 4> u; // offsets of a, b, c, p from the vertex of the star
  for (std::size_t k = 0; k < 4; ++k)
    u[k] = difference(test[k + 1].x, test[0].x);
  // of the lifts in the power, times the determinant of the cell; that of the vertex of
  // the star is minus the sum of the others
  std::array<Exact, 5> cofactors;
  cofactors[1] = -determinant(u[3], u[1], u[2]);
  cofactors[2] = -determinant(u[0], u[3], u[2]);
  cofactors[3] = -determinant(u[0], u[1], u[3]);
  cofactors[4] = determinant(u[0], u[1], u[2]);
  cofactors[0] = -(cofactors[1] + cofactors[2] + cofactors[3] + cofactors[4]);
  Exact power(0); // times the determinant
  for (std::size_t k = 0; k < 4; ++k)
    power += cofactors[k + 1] *
             (square(M, u[k]) + Exact(test[0].weight) - Exact(test[k + 1].weight));
  CGAL::Sign sign = CGAL::sign(power);
  std::array<std::size_t, 5> order;
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return test[i].rank > test[j].rank; });
  for (std::size_t k = 0; k < 5 && sign == CGAL::ZERO; ++k)
    sign = CGAL::sign(cofactors[order[k]]);
  return sign == CGAL::NEGATIVE ? Side::inside : Side::outside;
}

} // namespace anistar
