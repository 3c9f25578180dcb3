#include "certificate/surface/facet_bulge.h"

#include <algorithm>
#include <limits>

namespace anistar {
namespace {

/// A turn beyond this is no smooth surface; also what rounding leaves of it.
constexpr double largest_sine = .99;

/// The height of the circular arc over the middle of an edge, where `turn` is the
/// difference of the unit normals at its ends.
template <std::size_t d>
double arc_height(const Vector<d> &edge, const Vector<d> &turn) {
  const double length = edge.norm();
  if (!(length > 0))
    return 0;
  const double sine =
      std::clamp(turn.dot(edge) / (2 * length), -largest_sine, largest_sine);
  return .5 * length * sine / (1 + std::sqrt(1 - sine * sine));
}

/// Twice the area vector of the facet, in 2D its edge turned to the left.
template <std::size_t d>
Vector<d> area_vector(const std::array<Vector<d>, d> &corners) {
  const Vector<d> u = corners[1] - corners[0];
  if constexpr (d == 2)
    return {-u[1], u[0]};
  else
    return u.cross(Vector<3>(corners[2] - corners[0]));
}

/// The direction of the line of the centres: M^-1 area.
template <std::size_t d>
Vector<d> axis_of(const SymmetricTensor<d> &M, const Vector<d> &area) {
  const Matrix<d> L = lower_factor<d>(M);
  const Vector<d> across = L.template triangularView<Eigen::Lower>().solve(area);
  return L.transpose().template triangularView<Eigen::Upper>().solve(across);
}

/// The root nearest zero of a s^2 - b s + c.
double smallest_root(double a, double b, double c) {
  const double discriminant = b * b - 4 * a * c;
  if (!(discriminant >= 0))
    return std::numeric_limits<double>::quiet_NaN();
  const double root = std::sqrt(discriminant);
  return c == 0 ? 0 : 2 * c / (b + (b < 0 ? -root : root));
}

/// The line of the centres of the balls through a facet in affine coordinates of its
/// plane and, as the last one, the height in units of its area vector.
template <std::size_t d> struct CentreLine {
  std::array<double, d> from; ///< weights of the corners at the centre in the plane
  std::array<double, d> step;
  double rise;
};

template <std::size_t d>
CentreLine<d> centre_line(const SymmetricTensor<d> &M,
                          const std::array<Vector<d>, d> &corners,
                          const Vector<d> &area) {
  const Vector<d> axis = axis_of<d>(M, area);
  const double area2 = area.squaredNorm();
  const Vector<d> u = corners[1] - corners[0];
  CentreLine<d> line;
  line.rise = axis.dot(area) / area2;
  if constexpr (d == 2) {
    const double along = axis.dot(u) / u.squaredNorm();
    line.from = {.5, .5};
    line.step = {-along, along};
  } else {
    const Vector<d> w = corners[2] - corners[0];
    const double uu = quadratic<3>(M, u), ww = quadratic<3>(M, w),
                 uw = u.dot(product<3>(M, w)), det = uu * ww - uw * uw;
    const double p = ww * (uu - uw) / (2 * det), q = uu * (ww - uw) / (2 * det);
    const double along_u = axis.dot(w.cross(area)) / area2,
                 along_w = axis.dot(area.cross(u)) / area2;
    line.from = {1 - p - q, p, q};
    line.step = {-along_u - along_w, along_u, along_w};
  }
  return line;
}

} // namespace

template <std::size_t d>
FacetBulge<d> facet_bulge(const std::array<Vector<d>, d> &corners,
                          const std::array<Vector<d>, d> &normals) {
  const Vector<d> area = area_vector<d>(corners);
  const auto normal = [&](std::size_t k) -> Vector<d> {
    return normals[k].dot(area) < 0 ? -normals[k] : normals[k];
  };
  const auto height = [&](std::size_t i, std::size_t j) {
    return arc_height<d>(corners[j] - corners[i], normal(j) - normal(i));
  };
  if constexpr (d == 2)
    return {height(0, 1)};
  else
    return {height(1, 2), height(2, 0), height(0, 1)};
}

/// The height over weights b is 4 sum b_j b_k h_jk: along the line of the centres a
/// square polynomial, which is to be the height of the centre.
template <std::size_t d>
double surface_shift(const SymmetricTensor<d> &M,
                     const std::array<Vector<d>, d> &corners,
                     const FacetBulge<d> &bulge) {
  if (std::all_of(bulge.begin(), bulge.end(), [](double h) { return h == 0; }))
    return 0;
  const Vector<d> area = area_vector<d>(corners);
  const CentreLine<d> line = centre_line<d>(M, corners, area);
  double a = 0, b = 0, c = 0;
  for (std::size_t i = 0; i < bulge.size(); ++i) {
    const std::size_t j = d == 2 ? 0 : (i + 1) % d, k = d == 2 ? 1 : (i + 2) % d;
    const double h = 4 * bulge[i];
    a += h * line.step[j] * line.step[k];
    b += h * (line.from[j] * line.step[k] + line.step[j] * line.from[k]);
    c += h * line.from[j] * line.from[k];
  }
  return 2 * smallest_root(a, line.rise * area.norm() - b, c);
}

template <std::size_t d>
Circumsphere<d> surface_sphere(const SymmetricTensor<d> &M,
                               const SurfaceFacet<d> &facet) {
  const Vector<d> area = area_vector<d>(facet.corners);
  const std::array<double, d> weights = centre_line<d>(M, facet.corners, area).from;
  Vector<d> offset = .5 * facet.shift * axis_of<d>(M, area);
  for (std::size_t k = 1; k < d; ++k)
    offset += weights[k] * (facet.corners[k] - facet.corners[0]);
  return {facet.corners[0] + offset, std::sqrt(quadratic<d>(M, offset)), offset};
}

template FacetBulge<2> facet_bulge<2>(const std::array<Vector<2>, 2> &,
                                      const std::array<Vector<2>, 2> &);
template FacetBulge<3> facet_bulge<3>(const std::array<Vector<3>, 3> &,
                                      const std::array<Vector<3>, 3> &);
template double surface_shift<2>(const SymmetricTensor<2> &,
                                 const std::array<Vector<2>, 2> &,
                                 const FacetBulge<2> &);
template double surface_shift<3>(const SymmetricTensor<3> &,
                                 const std::array<Vector<3>, 3> &,
                                 const FacetBulge<3> &);
template Circumsphere<2> surface_sphere<2>(const SymmetricTensor<2> &,
                                           const SurfaceFacet<2> &);
template Circumsphere<3> surface_sphere<3>(const SymmetricTensor<3> &,
                                           const SurfaceFacet<3> &);

} // namespace anistar
