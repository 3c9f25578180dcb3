#pragma once
// Where new vertices of a surface or a ridge go.

#include "adjacency.h"
#include "tensor.h"

#include <functional>
#include <memory>
#include <span>

namespace anistar {

class SmoothSurface;

/// The surfaces and edges that bound or cross a domain.
struct SurfaceInput {
  std::span<const Vector<3>> points;
  std::span<const Facet<3>> facets;
  std::span<const Index> facet_tags;
  std::span<const std::array<Index, 2>> edges;
  std::span<const Index> edge_tags;
  std::span<const Index> corners;
  std::span<const Index> frozen_tags; ///< facets with these stay as they are
  double ridge_angle = 45;            ///< degrees
};

/// A smooth piece of surface with one tag.
struct Patch {
  Index tag = 0;
  bool is_planar = false;
  bool is_frozen = false;
  Vector<3> origin = Vector<3>::Zero(), normal = Vector<3>::Zero(); ///< of its plane
};

/// A smooth piece of ridge between two corners, or a closed one.
struct SurfaceCurve {
  Index tag = 0;
  bool is_given = false; ///< it has a tag; else an angle or a change of tags made it
  bool is_straight = false;
  Vector<3> origin = Vector<3>::Zero(), direction = Vector<3>::Zero(); ///< of its line
};

/// A user's own geometry: the point of the surface with this tag for a point near it.
using SurfaceProjection = std::function<Vector<3>(const Vector<3> &, Index tag)>;

/// Planes and lines are exact to round-off: what lies on one is put back on it. A
/// point of a curved patch or ridge goes to its foot on the smooth surface or ridge of
/// the geometry with its tag.
class SurfaceShape {
public:
  /// @param patches, curves those of the mesh
  /// @param geometry gives the shape of the curved ones
  SurfaceShape(std::vector<Patch> patches, std::vector<SurfaceCurve> curves,
               const SurfaceInput &geometry, SurfaceProjection projection);

  [[nodiscard]] const Patch &patch(Index p) const {
    return patches_[static_cast<std::size_t>(p)];
  }
  [[nodiscard]] const SurfaceCurve &curve(Index c) const {
    return curves_[static_cast<std::size_t>(c)];
  }
  [[nodiscard]] Vector<3> on_patch(Index p, const Vector<3> &x) const;
  [[nodiscard]] Vector<3> on_curve(Index c, const Vector<3> &x) const;
  /// The place near x for a vertex on a feature of this dimension.
  [[nodiscard]] Vector<3> place(Index dimension, Index lies_on,
                                const Vector<3> &x) const {
    return dimension == 2   ? on_patch(lies_on, x)
           : dimension == 1 ? on_curve(lies_on, x)
                            : x;
  }
  /// Distance of the middle of the edge ab from the feature, relative to its length.
  [[nodiscard]] double deviation(Index dimension, Index lies_on, const Vector<3> &a,
                                 const Vector<3> &b) const {
    if (is_flat(dimension, lies_on))
      return 0;
    const Vector<3> middle = .5 * (a + b);
    return (place(dimension, lies_on, middle) - middle).norm() / (b - a).norm();
  }
  /// Whether a user's projection may be called, which only the calling thread may do.
  [[nodiscard]] bool has_projection() const { return geometry_ && projection_; }
  [[nodiscard]] bool is_flat(Index dimension, Index lies_on) const {
    return dimension == 2   ? patch(lies_on).is_planar
           : dimension == 1 ? curve(lies_on).is_straight
                            : true;
  }

private:
  std::vector<Patch> patches_;
  std::vector<SurfaceCurve> curves_;
  std::shared_ptr<const SmoothSurface> geometry_; ///< null when nothing is curved
  SurfaceProjection projection_;
};

} // namespace anistar
