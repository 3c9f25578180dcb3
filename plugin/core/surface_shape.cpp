#include "surface_shape.h"

#include "smooth_surface.h"

#include <algorithm>

namespace anistar {
namespace {

/// Edges of a curved surface stay nearer to it than this, in the metric, or the layers
/// of cells along it cross it; but they need not be shorter than that.
constexpr double largest_lift = 1, shortest_lifted = .5;

} // namespace

SurfaceShape::SurfaceShape(std::vector<Patch> patches, std::vector<SurfaceCurve> curves,
                           const SurfaceInput &geometry, SurfaceProjection projection)
    : patches_(std::move(patches)), curves_(std::move(curves)),
      projection_(std::move(projection)) {
  const bool is_flat =
      std::all_of(patches_.begin(), patches_.end(),
                  [](const Patch &patch) { return patch.is_planar; }) &&
      std::all_of(curves_.begin(), curves_.end(),
                  [](const SurfaceCurve &curve) { return curve.is_straight; });
  if (!is_flat)
    geometry_ = std::make_shared<const SmoothSurface>(geometry);
}

Vector<3> SurfaceShape::on_patch(Index p, const Vector<3> &x) const {
  const Patch &here = patch(p);
  if (here.is_planar)
    return x - here.normal * here.normal.dot(x - here.origin);
  const CurvedPieces *pieces = geometry_->surface(here.tag);
  const Vector<3> near = pieces ? pieces->project(x).x : x;
  return projection_ ? projection_(near, here.tag) : near;
}

Vector<3> SurfaceShape::normal(Index p, const Vector<3> &x,
                               const Vector<3> &like) const {
  const Patch &here = patch(p);
  const CurvedPieces *pieces = here.is_planar ? nullptr : geometry_->surface(here.tag);
  Vector<3> n = here.is_planar ? here.normal : like;
  if (pieces)
    n = pieces->project(x).normal;
  const double size = n.norm();
  return n * ((n.dot(like) < 0 ? -1 : 1) / std::max(size, 1e-300));
}

Vector<3> SurfaceShape::on_curve(Index c, const Vector<3> &x) const {
  const SurfaceCurve &here = curve(c);
  if (here.is_straight)
    return here.origin + here.direction * here.direction.dot(x - here.origin);
  const CurvedPieces *pieces = geometry_->ridge(here.is_given, here.tag);
  return pieces ? pieces->project(x).x : x;
}

bool SurfaceShape::strays(Index dimension, Index lies_on, const Vertex<3> &a,
                          const Vertex<3> &b, double hausdorff_number) const {
  if (is_flat(dimension, lies_on))
    return false;
  const Vector<3> e = b.x - a.x, lift = this->lift(dimension, lies_on, a.x, b.x);
  if (lift.squaredNorm() > hausdorff_number * hausdorff_number * e.squaredNorm())
    return true;
  const auto square = [&](const Vector<3> &x) {
    return .5 * (quadratic<3>(a.M, x) + quadratic<3>(b.M, x));
  };
  return square(lift) > largest_lift * largest_lift &&
         square(e) > shortest_lifted * shortest_lifted;
}

} // namespace anistar
