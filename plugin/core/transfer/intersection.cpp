#include "transfer/intersection.h"

#include <algorithm>
#include <cmath>

namespace anistar {
namespace {

/// Forward error of the determinants below, relative to the sum of the absolute
/// products: the differences, the products and the sums each round once.
constexpr double determinant_error = 12 * 0x1p-53;

/// A point of both cells, in the barycentric coordinates of each.
template <std::size_t d> struct Corner { std::array<double, d + 1> target, source; };
template <std::size_t d> using Piece = std::array<Corner<d>, d + 1>;

/// The determinant of b - a and x - a (2D), or b - a, c - a and x - a (3D), 0 when its
/// round-off could have made it.
double snapped_determinant(const std::array<Vector<2>, 2> &facet, const Vector<2> &x) {
  const Vector<2> u = facet[1] - facet[0], v = x - facet[0];
  const double first = u[0] * v[1], second = u[1] * v[0];
  const double det = first - second;
  const double error = determinant_error * (std::abs(first) + std::abs(second));
  return std::abs(det) <= error ? 0 : det;
}

struct Plane {
  Vector<3> origin, normal, absolute; ///< normal with absolute products
};

Plane plane_of(const std::array<Vector<3>, 3> &facet) {
  const Vector<3> u = facet[1] - facet[0], v = facet[2] - facet[0];
  Plane plane{facet[0], {}, {}};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double first = u[j] * v[k], second = u[k] * v[j];
    plane.normal[i] = first - second;
    plane.absolute[i] = std::abs(first) + std::abs(second);
  }
  return plane;
}

double snapped_determinant(const Plane &plane, const Vector<3> &x) {
  const Vector<3> w = x - plane.origin;
  const double det = plane.normal.dot(w);
  const double error = determinant_error * plane.absolute.dot(w.cwiseAbs());
  return std::abs(det) <= error ? 0 : det;
}

template <std::size_t d>
std::array<Vector<d>, d> facet_points(const Simplex<d> &s, std::size_t i) {
  Cell<d> local;
  for (std::size_t k = 0; k <= d; ++k)
    local[k] = static_cast<Index>(k);
  const Facet<d> facet = facet_of<d>(local, i);
  std::array<Vector<d>, d> points;
  for (std::size_t k = 0; k < d; ++k)
    points[k] = s[facet[k]];
  return points;
}

template <std::size_t d> double determinant_of(const Piece<d> &piece) {
  std::array<std::array<double, d>, d> legs;
  for (std::size_t k = 0; k < d; ++k)
    for (std::size_t i = 0; i < d; ++i)
      legs[k][i] = piece[k + 1].target[i] - piece[0].target[i];
  if constexpr (d == 2)
    return legs[0][0] * legs[1][1] - legs[0][1] * legs[1][0];
  else
    return legs[0][0] * (legs[1][1] * legs[2][2] - legs[1][2] * legs[2][1]) -
           legs[0][1] * (legs[1][0] * legs[2][2] - legs[1][2] * legs[2][0]) +
           legs[0][2] * (legs[1][0] * legs[2][1] - legs[1][1] * legs[2][0]);
}

/// Cuts a simplex by the half-spaces source[j] >= 0 and adds up the moments of what
/// remains, in units of volume / ((d + 1) (d + 2)).
template <std::size_t d> class Clipper {
public:
  Moments<d> moments{};

  void cut(const Piece<d> &piece, std::size_t plane) {
    for (; plane <= d; ++plane) {
      std::size_t above = 0, below = 0;
      for (const Corner<d> &corner : piece) {
        above += corner.source[plane] > 0;
        below += corner.source[plane] < 0;
      }
      if (above == 0)
        return;
      if (below > 0) {
        split(piece, plane);
        return;
      }
    }
    add(piece);
  }

private:
  void split(const Piece<d> &piece, std::size_t plane) {
    std::array<const Corner<d> *, d + 1> in{}, out{};
    std::size_t n_in = 0, n_out = 0;
    for (const Corner<d> &corner : piece)
      if (corner.source[plane] >= 0)
        in[n_in++] = &corner;
      else
        out[n_out++] = &corner;
    if (n_in == 1) {
      Piece<d> tip;
      tip[0] = *in[0];
      for (std::size_t k = 0; k < d; ++k)
        tip[k + 1] = crossing(*in[0], *out[k], plane);
      cut(tip, plane + 1);
      return;
    }
    // a prism over two simplices of dimension d - 1: the facet inside and its section,
    // or in 3D with two corners on each side the triangles at the ends of the edge
    std::array<Corner<d>, d> lower, upper;
    if (n_out == 1) {
      for (std::size_t k = 0; k < d; ++k) {
        lower[k] = *in[k];
        upper[k] = crossing(*in[k], *out[0], plane);
      }
    } else {
      lower[0] = *in[0];
      upper[0] = *in[1];
      for (std::size_t k = 0; k < n_out; ++k) {
        lower[k + 1] = crossing(*in[0], *out[k], plane);
        upper[k + 1] = crossing(*in[1], *out[k], plane);
      }
    }
    for (std::size_t step = 0; step < d; ++step) {
      Piece<d> part;
      std::copy_n(lower.begin(), step + 1, part.begin());
      std::copy(upper.begin() + static_cast<std::ptrdiff_t>(step), upper.end(),
                part.begin() + static_cast<std::ptrdiff_t>(step) + 1);
      cut(part, plane + 1);
    }
  }

  static Corner<d> crossing(const Corner<d> &in, const Corner<d> &out,
                            std::size_t plane) {
    const double t = in.source[plane] / (in.source[plane] - out.source[plane]);
    Corner<d> point;
    for (std::size_t i = 0; i <= d; ++i) {
      point.target[i] = in.target[i] + t * (out.target[i] - in.target[i]);
      point.source[i] = in.source[i] + t * (out.source[i] - in.source[i]);
    }
    point.source[plane] = 0;
    return point;
  }

  /// The mean of b_i c_j over a simplex is (sum_i sum_j + sum_k b_ik c_jk) / ((d + 1)
  /// (d + 2)), with sums over its corners.
  void add(const Piece<d> &piece) {
    const double share = std::abs(determinant_of<d>(piece));
    std::array<double, d + 1> target{}, source{};
    for (const Corner<d> &corner : piece)
      for (std::size_t i = 0; i <= d; ++i) {
        target[i] += corner.target[i];
        source[i] += corner.source[i];
      }
    for (std::size_t i = 0; i <= d; ++i)
      for (std::size_t j = 0; j <= d; ++j) {
        double product = target[i] * source[j];
        for (const Corner<d> &corner : piece)
          product += corner.target[i] * corner.source[j];
        moments[i][j] += share * product;
      }
  }
};

} // namespace

template <std::size_t d>
Sides<d> sides(const Simplex<d> &target, const Simplex<d> &source) {
  Sides<d> at;
  for (std::size_t j = 0; j <= d; ++j) {
    const auto facet = facet_points<d>(source, j);
    if constexpr (d == 2) {
      for (std::size_t k = 0; k <= d; ++k)
        at[j][k] = snapped_determinant(facet, target[k]);
    } else {
      const Plane plane = plane_of(facet);
      for (std::size_t k = 0; k <= d; ++k)
        at[j][k] = snapped_determinant(plane, target[k]);
    }
  }
  const double scale = 1 / volume_determinant<d>(source);
  for (auto &row : at)
    for (double &coordinate : row)
      coordinate *= scale;
  return at;
}

template <std::size_t d>
Moments<d> intersection_moments(const Sides<d> &at, double volume) {
  Piece<d> whole{};
  for (std::size_t k = 0; k <= d; ++k) {
    whole[k].target[k] = 1;
    for (std::size_t j = 0; j <= d; ++j)
      whole[k].source[j] = at[j][k];
  }
  Clipper<d> clipper;
  clipper.cut(whole, 0);
  const double scale = volume / ((d + 1) * (d + 2));
  for (auto &row : clipper.moments)
    for (double &moment : row)
      moment *= scale;
  return clipper.moments;
}

template Sides<2> sides<2>(const Simplex<2> &, const Simplex<2> &);
template Sides<3> sides<3>(const Simplex<3> &, const Simplex<3> &);
template Moments<2> intersection_moments<2>(const Sides<2> &, double);
template Moments<3> intersection_moments<3>(const Sides<3> &, double);

} // namespace anistar
