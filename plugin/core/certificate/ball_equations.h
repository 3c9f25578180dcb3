#pragma once
// The linear equations that give the ball through the vertices of a cell, or of a facet
// and centred on a surface, and their solution, in any numbers.

#include "base/bounded.h"
#include "base/range.h"
#include "certificate/surface/surface_facet.h"
#include "mesh/measures.h"

#include <array>
#include <type_traits>

namespace anistar::ball_equations {

/// The determinant of the edge vectors from the first vertex, and the cofactors of
/// their squares in the equations of g: 2 g = sum_k square_k cofactor_k / determinant.
template <std::size_t d, class Number> struct Frame {
  using Row = std::array<Number, d>;
  std::array<Row, d> edges, cofactors;
  Number determinant;
};

template <std::size_t d, class Number>
std::array<Number, d> difference(const Vector<d> &x, const Vector<d> &origin) {
  if constexpr (!std::is_same_v<Number, double> && !std::is_same_v<Number, Bounded>) {
    require_finite(x);
    require_finite(origin);
  }
  std::array<Number, d> out;
  for (std::size_t i = 0; i < d; ++i)
    out[i] = Number(x[static_cast<int>(i)]) - Number(origin[static_cast<int>(i)]);
  return out;
}

template <class Number>
std::array<Number, 3> cross_product(const std::array<Number, 3> &u,
                                    const std::array<Number, 3> &v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
          u[0] * v[1] - u[1] * v[0]};
}

template <std::size_t d, class Number>
Number dot(const std::array<Number, d> &u, const std::array<Number, d> &v) {
  Number sum = u[0] * v[0];
  for (std::size_t i = 1; i < d; ++i)
    sum = sum + u[i] * v[i];
  return sum;
}

template <std::size_t d, class Number>
Frame<d, Number> frame_of(const Simplex<d> &simplex) {
  Frame<d, Number> f;
  for (std::size_t k = 0; k < d; ++k)
    f.edges[k] = difference<d, Number>(simplex[k + 1], simplex[0]);
  const auto &e = f.edges;
  if constexpr (d == 2)
    f.cofactors = {{{e[1][1], -e[1][0]}, {-e[0][1], e[0][0]}}};
  else
    f.cofactors = {cross_product(e[1], e[2]), cross_product(e[2], e[0]),
                   cross_product(e[0], e[1])};
  f.determinant = dot<d, Number>(e[0], f.cofactors[0]);
  return f;
}

template <std::size_t d, class Number>
std::array<Number, d> product_of(const SymmetricTensor<d> &M,
                                 const std::array<Number, d> &v) {
  std::array<Number, d> out;
  for (std::size_t i = 0; i < d; ++i) {
    out[i] = Number(M(i, 0)) * v[0];
    for (std::size_t j = 1; j < d; ++j)
      out[i] = out[i] + Number(M(i, j)) * v[j];
  }
  return out;
}

template <std::size_t d, class Number>
Number bilinear(const SymmetricTensor<d> &M, const std::array<Number, d> &u,
                const std::array<Number, d> &v) {
  return dot<d, Number>(product_of<d, Number>(M, v), u);
}

/// The product with the matrix of the cofactors of M.
template <class Number>
std::array<Number, 3> cofactor_product(const SymmetricTensor<3> &M,
                                       const std::array<Number, 3> &v) {
  std::array<std::array<Number, 3>, 3> rows;
  for (std::size_t i = 0; i < 3; ++i)
    rows[i] = {Number(M(i, 0)), Number(M(i, 1)), Number(M(i, 2))};
  return {dot<3, Number>(cross_product(rows[1], rows[2]), v),
          dot<3, Number>(cross_product(rows[2], rows[0]), v),
          dot<3, Number>(cross_product(rows[0], rows[1]), v)};
}

/// The solution 2 g = gradient / determinant of the equations of a ball.
template <std::size_t d, class Number> struct Solution {
  Number determinant;
  std::array<Number, d> gradient;
};

template <std::size_t d, class Number>
Solution<d, Number> solution_of(const SymmetricTensor<d> &M,
                                const Simplex<d> &simplex) {
  const Frame<d, Number> f = frame_of<d, Number>(simplex);
  Solution<d, Number> out{f.determinant, {}};
  out.gradient.fill(Number(0.));
  for (std::size_t k = 0; k < d; ++k) {
    const Number square = bilinear<d, Number>(M, f.edges[k], f.edges[k]);
    for (std::size_t i = 0; i < d; ++i)
      out.gradient[i] = out.gradient[i] + square * f.cofactors[k][i];
  }
  return out;
}

/// See surface_facet.h for the equations. In the plane of a facet with edges u, w and
/// the normal n = u x w, the centre of its ball obeys 2 g.N = 0 with N = cof(M) n.
template <std::size_t d, class Number>
Solution<d, Number> solution_of(const SymmetricTensor<d> &M,
                                const SurfaceFacet<d> &facet) {
  const auto u = difference<d, Number>(facet.corners[1], facet.corners[0]);
  Solution<d, Number> out;
  if constexpr (d == 2) {
    out = {Number(1.), product_of<2, Number>(M, u)};
    const std::array<Number, 2> normal{-u[1], u[0]};
    for (std::size_t i = 0; i < d; ++i)
      out.gradient[i] = out.gradient[i] + Number(facet.shift) * normal[i];
  } else {
    const auto w = difference<d, Number>(facet.corners[2], facet.corners[0]);
    const auto n = cross_product(u, w), N = cofactor_product(M, n);
    const auto across_u = cross_product(w, N), across_w = cross_product(N, u);
    const Number uu = bilinear<3, Number>(M, u, u), ww = bilinear<3, Number>(M, w, w);
    out.determinant = dot<3, Number>(N, n);
    const Number along = Number(facet.shift) * out.determinant;
    for (std::size_t i = 0; i < d; ++i)
      out.gradient[i] = uu * across_u[i] + ww * across_w[i] + along * n[i];
  }
  return out;
}

} // namespace anistar::ball_equations
