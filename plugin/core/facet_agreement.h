#pragma once
// The local test of agreement at a facet of a tetrahedral mesh.
//
// The in-sphere determinant of five points is linear in the metric:
// sum_i c_i u_i^T M u_i = <M, K> with K = sum_i c_i u_i u_i^T, so that a facet costs
// one tensor K and one dot product for each of the five metrics.

#include "measures.h"

namespace anistar {

/// The tensor K of the cell (a, b, c, e) and a point p: <M, K> > 0 when p lies in the
/// M-circumball of the cell. It proposes, and decides nothing.
/// @pre the cell is positive.
[[nodiscard]] inline SymmetricTensor<3>
sphere_tensor(const Vector<3> &a, const Vector<3> &b, const Vector<3> &c,
              const Vector<3> &e, const Vector<3> &p) {
  const Vector<3> u = a - p, v = b - p, w = c - p, x = e - p;
  const Vector<3> vw = v.cross(w), ux = u.cross(x);
  const std::array<double, 4> cofactors{x.dot(vw), w.dot(ux), -v.dot(ux), -u.dot(vw)};
  const std::array<const Vector<3> *, 4> offsets{&u, &v, &w, &x};
  SymmetricTensor<3> K;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j <= i; ++j)
        K(i, j) += cofactors[k] * (*offsets[k])[static_cast<int>(i)] *
                   (*offsets[k])[static_cast<int>(j)];
  return K;
}

/// The sum of the products of all entries of two tensors.
[[nodiscard]] inline double contract(const SymmetricTensor<3> &A,
                                     const SymmetricTensor<3> &B) {
  const auto &a = A.entries, &b = B.entries;
  return a[0] * b[0] + a[2] * b[2] + a[5] * b[5] +
         2 * (a[1] * b[1] + a[3] * b[3] + a[4] * b[4]);
}

/// Whether the facet abc between the positive cell (a, b, c, e) and p is not Delaunay
/// in the metric of one of the five vertices: necessary for a certificate.
[[nodiscard]] inline bool metrics_disagree(const Vertex<3> &a, const Vertex<3> &b,
                                           const Vertex<3> &c, const Vertex<3> &e,
                                           const Vertex<3> &p) {
  const SymmetricTensor<3> K = sphere_tensor(a.x, b.x, c.x, e.x, p.x);
  for (const Vertex<3> *v : {&a, &b, &c, &e, &p})
    if (contract(v->M, K) > 0)
      return true;
  return false;
}

} // namespace anistar
