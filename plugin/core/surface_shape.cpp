#include "surface_shape.h"

#include "nearest_on.h"
#include "surface_features.h"

namespace anistar {
namespace {

std::vector<Box<3>> boxes_of(const std::vector<std::array<Vector<3>, 3>> &triangles) {
  std::vector<Box<3>> boxes(triangles.size());
  for (std::size_t k = 0; k < triangles.size(); ++k)
    for (const Vector<3> &x : triangles[k])
      boxes[k].extend(x);
  return boxes;
}

/// Ridges that an angle made carry no tag of their own.
constexpr Index untagged = std::numeric_limits<Index>::min();

Index key_of(const Curve &curve) { return curve.is_given ? curve.tag : untagged; }

} // namespace

SurfaceShape::SurfaceShape(std::vector<Patch> patches, std::vector<Curve> curves,
                           const SurfaceInput &geometry, SurfaceProjection projection)
    : patches_(std::move(patches)), curves_(std::move(curves)),
      projection_(std::move(projection)) {
  const auto is_curved = [](const auto &piece) {
    if constexpr (requires { piece.is_planar; })
      return !piece.is_planar;
    else
      return !piece.is_straight;
  };
  if (std::none_of(patches_.begin(), patches_.end(), is_curved) &&
      std::none_of(curves_.begin(), curves_.end(), is_curved))
    return;
  const auto pieces_with = [](std::vector<Pieces> &all, Index tag) -> Pieces & {
    for (Pieces &pieces : all)
      if (pieces.tag == tag)
        return pieces;
    return all.emplace_back(Pieces{tag, {}, BoxTree<3>{{}}});
  };
  const auto at = [&](Index v) -> const Vector<3> & {
    return geometry.points[static_cast<std::size_t>(v)];
  };
  for (std::size_t f = 0; f < geometry.facets.size(); ++f) {
    const Facet<3> &t = geometry.facets[f];
    pieces_with(surfaces_, geometry.facet_tags[f])
        .triangles.push_back({at(t[0]), at(t[1]), at(t[2])});
  }
  const Features features = find_features(geometry);
  for (const RidgeSegment &ridge : features.ridges) {
    const Curve &curve = features.curves[static_cast<std::size_t>(ridge.curve)];
    pieces_with(ridges_, key_of(curve))
        .triangles.push_back({at(ridge.ends[0]), at(ridge.ends[1]), at(ridge.ends[1])});
  }
  for (std::vector<Pieces> *all : {&surfaces_, &ridges_})
    for (Pieces &pieces : *all)
      pieces.tree = BoxTree<3>(boxes_of(pieces.triangles));
}

std::optional<Vector<3>> SurfaceShape::nearest(const std::vector<Pieces> &all,
                                               Index tag, const Vector<3> &x) {
  for (const Pieces &pieces : all) {
    if (pieces.tag != tag)
      continue;
    Vector<3> best = x;
    double best_distance = std::numeric_limits<double>::infinity();
    pieces.tree.nearest(x, best_distance, [&](Index item, double) {
      const auto &corners = pieces.triangles[static_cast<std::size_t>(item)];
      const std::array<double, 3> weight = nearest_on(x, corners);
      const Vector<3> foot =
          weight[0] * corners[0] + weight[1] * corners[1] + weight[2] * corners[2];
      const double distance = (foot - x).squaredNorm();
      if (distance < best_distance) {
        best_distance = distance;
        best = foot;
      }
      return best_distance;
    });
    return best;
  }
  return std::nullopt;
}

Vector<3> SurfaceShape::on_patch(Index p, const Vector<3> &x) const {
  const Patch &here = patch(p);
  if (here.is_planar)
    return x - here.normal * here.normal.dot(x - here.origin);
  const Vector<3> near = nearest(surfaces_, here.tag, x).value_or(x);
  return projection_ ? projection_(near, here.tag) : near;
}

Vector<3> SurfaceShape::on_curve(Index c, const Vector<3> &x) const {
  const Curve &here = curve(c);
  if (here.is_straight)
    return here.origin + here.direction * here.direction.dot(x - here.origin);
  return nearest(ridges_, key_of(here), x).value_or(x);
}

} // namespace anistar
