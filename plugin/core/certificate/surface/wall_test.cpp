#include "certificate/surface/wall_test.h"

#include "certificate/circumball.h"
#include "certificate/surface/facet_bulge.h"

#include <algorithm>
#include <cmath>

namespace anistar {
namespace {

/// What an exact answer is returned as when the rounded value has the other sign.
constexpr double barely = 1e-30;
/// Rounded margins above this have the right sign, unless the facet is a needle.
constexpr double blurred = 1e-10;
/// Of a facet that no surface ball goes through.
constexpr double no_ball = 1;

/// An M-ball through a facet: its power at the offset y from the first corner is
/// y^T M y - in_plane.y - across.y.
struct SurfaceBall {
  Vector<3> in_plane; ///< twice M times the offset of the centre in the plane
  Vector<3> across;   ///< the shift times the normal

  [[nodiscard]] double margin(const SymmetricTensor<3> &M, const Vector<3> &y) const {
    const double square = quadratic<3>(M, y), along = in_plane.dot(y),
                 beside = across.dot(y);
    return (along + beside - square) / (square + std::abs(along) + std::abs(beside));
  }
};

SurfaceBall surface_ball(const SymmetricTensor<3> &M, const SurfaceFacet<3> &facet) {
  const Vector<3> u = facet.corners[1] - facet.corners[0],
                  w = facet.corners[2] - facet.corners[0];
  const Vector<3> Mu = product<3>(M, u), Mw = product<3>(M, w);
  const double uu = Mu.dot(u), ww = Mw.dot(w), uw = Mu.dot(w),
               determinant = uu * ww - uw * uw;
  const double at_u = ww * (uu - uw) / determinant, at_w = uu * (ww - uw) / determinant;
  return {at_u * Mu + at_w * Mw, facet.shift * u.cross(w)};
}

/// The sign of the margin, when rounding could have changed it.
double decided(const SymmetricTensor<3> &M, const SurfaceFacet<3> &facet,
               const Vector<3> &x, double margin) {
  const Circumball<3> ball(M, facet);
  return ball.side(x, ball.power(x)) == Side::inside ? std::max(margin, barely)
                                                     : std::min(margin, -barely);
}

} // namespace

std::array<SurfaceFacet<3>, 3> surface_facets(const WallStar &star) {
  const std::array<Vector<3>, 3> corners{star.corners[0]->x, star.corners[1]->x,
                                         star.corners[2]->x};
  FacetBulge<3> bulge{};
  const auto is_known = [](const Vector<3> *normal) { return normal != nullptr; };
  if (std::all_of(star.normals.begin(), star.normals.end(), is_known))
    bulge =
        facet_bulge<3>(corners, {*star.normals[0], *star.normals[1], *star.normals[2]});
  std::array<SurfaceFacet<3>, 3> seen;
  for (std::size_t k = 0; k < 3; ++k) {
    seen[k].corners = turned(corners, k);
    seen[k].shift =
        surface_shift<3>(star.corners[k]->M, seen[k].corners, turned(bulge, k));
  }
  return seen;
}

double wall_margin(const WallStar &star) {
  const std::array<SurfaceFacet<3>, 3> facets = surface_facets(star);
  double worst = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const SymmetricTensor<3> &M = star.corners[k]->M;
    if (!std::isfinite(facets[k].shift))
      return no_ball;
    const SurfaceBall ball = surface_ball(M, facets[k]);
    for (const Vertex<3> *apex : star.apexes) {
      if (!apex)
        continue;
      double margin = ball.margin(M, apex->x - facets[k].corners[0]);
      if (!(std::abs(margin) > blurred))
        margin = decided(M, facets[k], apex->x, margin);
      worst = std::max(worst, margin);
    }
  }
  return worst;
}

} // namespace anistar
