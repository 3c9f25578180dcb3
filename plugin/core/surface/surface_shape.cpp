#include "surface/surface_shape.h"

#include "surface/smooth_surface.h"

#include <algorithm>
#include <numeric>

namespace anistar {
namespace {

/// Edges of a curved surface stay nearer to it than this, in the metric, or the layers
/// of cells along it cross it; but they need not be shorter than that.
constexpr double largest_lift = 1, shortest_lifted = .5;

/// A vertex says more of what a patch is than the middle of a facet.
constexpr double own_vote = 100;
/// Features with a smaller share of the votes are neighbours met by chance.
constexpr double least_share = .05;

const FeatureSet &chosen(const std::vector<FeatureSet> &of, Index i) {
  static const FeatureSet everything;
  return of.empty() ? everything : of[i];
}

class Votes {
public:
  Votes(std::size_t n, std::size_t n_candidates)
      : votes_(n, std::vector<double>(n_candidates, 0)) {}
  void add(Index i, Index candidate, double weight) { votes_[i][candidate] += weight; }
  [[nodiscard]] std::vector<FeatureSet> winners() const {
    std::vector<FeatureSet> all(votes_.size());
    for (std::size_t i = 0; i < votes_.size(); ++i) {
      const double total = std::accumulate(votes_[i].begin(), votes_[i].end(), 0.);
      if (total > 0)
        for (double n : votes_[i])
          all[i].push_back(n >= least_share * total);
    }
    return all;
  }

private:
  std::vector<std::vector<double>> votes_;
};

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

void SurfaceShape::match(const SurfaceInput &input, const Features &features) {
  if (!geometry_)
    return;
  const auto point = [&](Index v) -> const Vector<3> & { return input.points[v]; };
  Votes patches(patches_.size(), geometry_->n_patches()),
      curves(curves_.size(), geometry_->n_curves());
  for (std::size_t f = 0; f < input.facets.size(); ++f) {
    const Index p = features.facet_patch[f];
    const Facet<3> &t = input.facets[f];
    const CurvedPieces *pieces = geometry_->surface(patch(p).tag);
    if (patch(p).is_planar || !pieces)
      continue;
    for (Index v : t) // only vertices are on the geometry
      if (features.dimension[v] == 2)
        patches.add(p, pieces->nearest_feature(point(v)), own_vote);
    const Vector<3> middle = (point(t[0]) + point(t[1]) + point(t[2])) / 3;
    patches.add(p, pieces->nearest_feature(middle), 1);
  }
  for (const RidgeSegment &ridge : features.ridges) {
    const SurfaceCurve &here = curve(ridge.curve);
    const CurvedPieces *pieces = geometry_->ridge(here.is_given, here.tag);
    if (here.is_straight || !pieces)
      continue;
    for (Index v : ridge.ends)
      if (features.dimension[v] == 1)
        curves.add(ridge.curve, pieces->nearest_feature(point(v)), own_vote);
    const Vector<3> middle = .5 * (point(ridge.ends[0]) + point(ridge.ends[1]));
    curves.add(ridge.curve, pieces->nearest_feature(middle), 1);
  }
  patches_of_ = patches.winners();
  curves_of_ = curves.winners();
}

SurfaceFoot SurfaceShape::foot(Index p, const Vector<3> &x) const {
  const Patch &here = patch(p);
  if (here.is_planar)
    return {x - here.normal * here.normal.dot(x - here.origin), here.normal};
  SurfaceFoot foot{x, Vector<3>::Zero()};
  if (const CurvedPieces *pieces = geometry_->surface(here.tag)) {
    const CurvedPieces::Foot found = pieces->project(x, chosen(patches_of_, p));
    foot = {found.x, found.normal / std::max(found.normal.norm(), 1e-300)};
  }
  if (projection_)
    foot.x = projection_(foot.x, here.tag);
  return foot;
}

Vector<3> SurfaceShape::normal(Index p, const Vector<3> &x,
                               const Vector<3> &like) const {
  const Patch &here = patch(p);
  const CurvedPieces *pieces = here.is_planar ? nullptr : geometry_->surface(here.tag);
  Vector<3> n = here.is_planar ? here.normal : like;
  if (pieces)
    n = pieces->project(x, chosen(patches_of_, p)).normal;
  const double size = n.norm();
  return n * ((n.dot(like) < 0 ? -1 : 1) / std::max(size, 1e-300));
}

Vector<3> SurfaceShape::on_curve(Index c, const Vector<3> &x) const {
  const SurfaceCurve &here = curve(c);
  if (here.is_straight)
    return here.origin + here.direction * here.direction.dot(x - here.origin);
  const CurvedPieces *pieces = geometry_->ridge(here.is_given, here.tag);
  return pieces ? pieces->project(x, chosen(curves_of_, c)).x : x;
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
