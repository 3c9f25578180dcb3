#include "base/predicates.h"

#include "base/range.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Gmpzf.h>

namespace anistar {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Gmpzf;

Orientation as_orientation(CGAL::Sign sign) {
  return static_cast<Orientation>(static_cast<int>(sign));
}

Side as_side(CGAL::Sign sign) { return static_cast<Side>(static_cast<int>(sign)); }

template <class... Numbers> void require_all_finite(const Numbers &...numbers) {
  (require_finite(numbers), ...);
}

template <std::size_t d>
std::array<Exact, d> exact_difference(const Vector<d> &x, const Vector<d> &p) {
  std::array<Exact, d> out;
  for (std::size_t i = 0; i < d; ++i)
    out[i] = Exact(x[static_cast<int>(i)]) - Exact(p[static_cast<int>(i)]);
  return out;
}

template <std::size_t d>
Exact exact_square(const SymmetricTensor<d> &M, const std::array<Exact, d> &u) {
  Exact sum(0);
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = 0; j < d; ++j)
      sum += Exact(M(i, j)) * u[i] * u[j];
  return sum;
}

Exact determinant2(const std::array<Exact, 2> &u, const std::array<Exact, 2> &v) {
  return u[0] * v[1] - u[1] * v[0];
}

Exact determinant3(const std::array<Exact, 3> &u, const std::array<Exact, 3> &v,
                   const std::array<Exact, 3> &w) {
  return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
         u[2] * (v[0] * w[1] - v[1] * w[0]);
}

Exact exact_sphere_determinant(const SymmetricTensor<2> &M, const Vector<2> &a,
                               const Vector<2> &b, const Vector<2> &c,
                               const Vector<2> &p) {
  const auto u = exact_difference<2>(a, p), v = exact_difference<2>(b, p),
             w = exact_difference<2>(c, p);
  return determinant2(v, w) * exact_square<2>(M, u) +
         determinant2(w, u) * exact_square<2>(M, v) +
         determinant2(u, v) * exact_square<2>(M, w);
}

} // namespace

namespace detail {

Orientation exact_orientation(const Vector<2> &a, const Vector<2> &b,
                              const Vector<2> &c) {
  require_all_finite(a, b, c);
  const auto point = [](const Vector<2> &x) { return Kernel::Point_2(x[0], x[1]); };
  return as_orientation(CGAL::orientation(point(a), point(b), point(c)));
}

Orientation exact_orientation(const Vector<3> &a, const Vector<3> &b,
                              const Vector<3> &c, const Vector<3> &e) {
  require_all_finite(a, b, c, e);
  const auto point = [](const Vector<3> &x) {
    return Kernel::Point_3(x[0], x[1], x[2]);
  };
  return as_orientation(CGAL::orientation(point(a), point(b), point(c), point(e)));
}

Side exact_in_sphere(const SymmetricTensor<2> &M, const Vector<2> &a,
                     const Vector<2> &b, const Vector<2> &c, const Vector<2> &p) {
  require_all_finite(M.entries, a, b, c, p);
  return as_side(CGAL::sign(exact_sphere_determinant(M, a, b, c, p)));
}

Side exact_in_sphere(const SymmetricTensor<3> &M, const Vector<3> &a,
                     const Vector<3> &b, const Vector<3> &c, const Vector<3> &e,
                     const Vector<3> &p) {
  require_all_finite(M.entries, a, b, c, e, p);
  const auto u = exact_difference<3>(a, p), v = exact_difference<3>(b, p),
             w = exact_difference<3>(c, p), x = exact_difference<3>(e, p);
  const Exact det = determinant3(u, v, w) * exact_square<3>(M, x) -
                    determinant3(v, w, x) * exact_square<3>(M, u) +
                    determinant3(u, w, x) * exact_square<3>(M, v) -
                    determinant3(u, v, x) * exact_square<3>(M, w);
  return as_side(CGAL::sign(-det));
}

} // namespace detail

Side in_metric_sphere(const SymmetricTensor<3> &M, const Vector<3> &a,
                      const Vector<3> &b, const Vector<3> &c, const Vector<3> &e,
                      const Vector<3> &p) {
  const std::array<Vector<3>, 4> u{a - p, b - p, c - p, e - p};
  const SymmetricTensor<3> magnitude = [&] {
    SymmetricTensor<3> out = M;
    for (double &entry : out.entries)
      entry = std::abs(entry);
    return out;
  }();
  double det = 0, size = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector<3> &r = u[i == 0 ? 1 : 0], &s = u[i <= 1 ? 2 : 1],
                    &t = u[i <= 2 ? 3 : 2];
    const double minor = r.dot(s.cross(t));
    const Vector<3> R = r.cwiseAbs(), S = s.cwiseAbs(), T = t.cwiseAbs();
    const double minor_size = R[0] * (S[1] * T[2] + S[2] * T[1]) +
                              R[1] * (S[2] * T[0] + S[0] * T[2]) +
                              R[2] * (S[0] * T[1] + S[1] * T[0]);
    // expansion of the 4x4 determinant along the column of squares, sign so that a
    // positive value means inside for positively oriented abce
    det += (i % 2 == 0 ? 1 : -1) * minor * quadratic<3>(M, u[i]);
    size += minor_size * quadratic<3>(magnitude, u[i].cwiseAbs());
  }
  if (size > detail::underflow_guard) {
    const double bound = detail::sphere_bound_3 * size;
    if (det > bound)
      return Side::inside;
    if (det < -bound)
      return Side::outside;
  }
  return detail::exact_in_sphere(M, a, b, c, e, p);
}

} // namespace anistar
