#pragma once
// Lengths and qualities in a metric, as every report defines them.

#include "base/predicates.h"
#include "base/tensor.h"
#include "mesh/adjacency.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace anistar {

/// Edges within [1/sqrt 2, sqrt 2] are unit edges.
inline constexpr double shortest_unit = std::numbers::sqrt2 / 2;
inline constexpr double longest_unit = std::numbers::sqrt2;

/// What a metric mesher knows of a vertex.
template <std::size_t d> struct Vertex {
  Vector<d> x;
  SymmetricTensor<d> M;
  double weight = 1; ///< 1 / sqrt(det M): M * weight has determinant 1 in 2D
};

template <std::size_t d>
[[nodiscard]] Vertex<d> make_vertex(const Vector<d> &x, const SymmetricTensor<d> &M) {
  return {x, M, 1 / std::sqrt(definite_determinant<d>(M))};
}

/// Mean of the lengths la, lb of an edge in the metrics of its ends, for a size that
/// varies geometrically in between.
[[nodiscard]] inline double mean_length(double la, double lb) {
  const double r = (la - lb) / (la + lb), x = r * r, x2 = x * x, mean = .5 * (la + lb);
  // log(la / lb) = 2 atanh r, and the series of r / atanh r costs less than a logarithm
  constexpr double near = 4e-4, far = 1. / 16;
  if (x < near) // the next term is below 1e-8
    return mean * (1 - x / 3);
  if (x < far) { // and here below 2e-11
    constexpr double c[] = {1.,     1. / 3,  1. / 5,  1. / 7,
                            1. / 9, 1. / 11, 1. / 13, 1. / 15};
    return mean / ((c[0] + c[1] * x) + x2 * (c[2] + c[3] * x) +
                   x2 * x2 * ((c[4] + c[5] * x) + x2 * (c[6] + c[7] * x)));
  }
  return (la - lb) / elementary::log(la / lb);
}

template <std::size_t d>
[[nodiscard]] inline double edge_length(const Vertex<d> &a, const Vertex<d> &b) {
  const Vector<d> e = b.x - a.x;
  return mean_length(std::sqrt(quadratic<d>(a.M, e)), std::sqrt(quadratic<d>(b.M, e)));
}

/// The mean ratio of a simplex in the metric of the corner where it is densest: 1 for a
/// unit regular simplex, <= 0 when inverted.
[[nodiscard]] inline double quality(const Vertex<2> &a, const Vertex<2> &b,
                                    const Vertex<2> &c) {
  const Vector<2> u = b.x - a.x, v = c.x - a.x, w = c.x - b.x;
  const Vertex<2> &dense = a.weight <= b.weight ? (a.weight <= c.weight ? a : c)
                                                : (b.weight <= c.weight ? b : c);
  const double squares =
      quadratic<2>(dense.M, u) + quadratic<2>(dense.M, v) + quadratic<2>(dense.M, w);
  return 2 * std::numbers::sqrt3 * cross(u, v) / (dense.weight * squares);
}

/// The same for a tetrahedron.
[[nodiscard]] inline double quality(const Vertex<3> &a, const Vertex<3> &b,
                                    const Vertex<3> &c, const Vertex<3> &e) {
  const Vertex<3> *dense = &a;
  for (const Vertex<3> *v : {&b, &c, &e})
    if (v->weight < dense->weight)
      dense = v;
  const Vector<3> u = b.x - a.x, v = c.x - a.x, w = e.x - a.x;
  const SymmetricTensor<3> &M = dense->M;
  const double squares = quadratic<3>(M, u) + quadratic<3>(M, v) + quadratic<3>(M, w) +
                         quadratic<3>(M, Vector<3>(v - u)) +
                         quadratic<3>(M, Vector<3>(w - u)) +
                         quadratic<3>(M, Vector<3>(w - v));
  // the volume of the unit regular tetrahedron is sqrt(2) / 12
  const double det = u.dot(v.cross(w)) / dense->weight;
  const double root = elementary::cube_root(det * std::numbers::sqrt2);
  return std::copysign(6 * root * root / squares, det);
}

/// The circumscribed ellipsoid of a simplex in a metric.
template <std::size_t d> struct Circumsphere {
  Vector<d> centre;
  double radius;
  Vector<d> offset; ///< of the centre from the first vertex, with its own accuracy
};
using Circumcircle = Circumsphere<2>;

/// @pre a, b, c turn left.
[[nodiscard]] inline Circumcircle circumcircle(const SymmetricTensor<2> &M,
                                               const Vector<2> &a, const Vector<2> &b,
                                               const Vector<2> &c) {
  const Vector<2> u = b - a, v = c - a;
  const double area = cross(u, v), det = determinant<2>(M);
  const double uu = quadratic<2>(M, u), vv = quadratic<2>(M, v);
  // M offset = g with 2 g.u = uu and 2 g.v = vv
  const double gx = (uu * v[1] - vv * u[1]) / (2 * area);
  const double gy = (vv * u[0] - uu * v[0]) / (2 * area);
  const Vector<2> offset((M(1, 1) * gx - M(0, 1) * gy) / det,
                         (M(0, 0) * gy - M(0, 1) * gx) / det);
  return {a + offset, std::sqrt(std::max(0., offset[0] * gx + offset[1] * gy)), offset};
}

/// @pre the simplex is positively oriented.
template <std::size_t d>
[[nodiscard]] inline Circumsphere<d> circumsphere(const SymmetricTensor<d> &M,
                                                  const Simplex<d> &s) {
  if constexpr (d == 2) {
    return circumcircle(M, s[0], s[1], s[2]);
  } else {
    const Vector<3> u = s[1] - s[0], v = s[2] - s[0], w = s[3] - s[0];
    const Vector<3> vw = v.cross(w);
    // M offset = g with 2 g.u = u^T M u, and so for v and w
    const Vector<3> g = (quadratic<3>(M, u) * vw + quadratic<3>(M, v) * w.cross(u) +
                         quadratic<3>(M, w) * u.cross(v)) /
                        (2 * u.dot(vw));
    const Matrix<3> L = lower_factor(M);
    const Vector<3> y = L.template triangularView<Eigen::Lower>().solve(g);
    const Vector<3> offset =
        L.transpose().template triangularView<Eigen::Upper>().solve(y);
    return {s[0] + offset, y.norm(), offset};
  }
}

/// The signed area (2D) or volume (3D).
template <std::size_t d> [[nodiscard]] inline double volume(const Simplex<d> &s) {
  return volume_determinant<d>(s) / (d == 2 ? 2 : 6);
}

/// The length of the shortest edge of a simplex in a metric.
template <std::size_t d>
[[nodiscard]] inline double shortest_length(const SymmetricTensor<d> &M,
                                            const Simplex<d> &s) {
  double square = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = i + 1; j <= d; ++j)
      square = std::min(square, quadratic<d>(M, s[j] - s[i]));
  return std::sqrt(square);
}

/// (Vol / e^d)^(1/d), the sliverity ratio of section 3.2 of RR-7712 v2.
template <std::size_t d>
[[nodiscard]] inline double sliverity(double volume, double shortest) {
  return (d == 2 ? std::sqrt(volume) : elementary::cube_root(volume)) / shortest;
}

} // namespace anistar
