#pragma once
// Where new vertices of a surface or a ridge go.

#include "base/range.h"
#include "mesh/measures.h"
#include "surface/surface_input.h"

#include <functional>
#include <memory>

namespace anistar {

class SmoothSurface;
struct Features;

/// Facets of a curved surface make a smaller angle with it than this (its cosine), or
/// become better.
inline constexpr double smallest_facet_cosine = .5;

/// A user's own geometry: the point of the surface with this tag for a point near it.
using SurfaceProjection = std::function<Vector<3>(const Vector<3> &, Index tag)>;

/// A point of a surface, and the unit normal there.
struct SurfaceFoot {
  Vector<3> x, normal;
};

/// Planes and lines are exact to round-off: what lies on one is put back on it. A
/// point of a curved patch or ridge goes to its foot on the smooth surface or ridge of
/// the geometry with its tag.
class SurfaceShape {
public:
  /// @param patches, curves those of the mesh
  /// @param geometry gives the shape of the curved ones
  SurfaceShape(std::vector<Patch> patches, std::vector<SurfaceCurve> curves,
               const SurfaceInput &geometry, SurfaceProjection projection);

  [[nodiscard]] const Patch &patch(Index p) const { return patches_[p]; }
  [[nodiscard]] const SurfaceCurve &curve(Index c) const { return curves_[c]; }
  /// Finds which patches and curves of the geometry those of the mesh are, so that
  /// sheets with the same tag that come near each other are not mistaken.
  void match(const SurfaceInput &input, const Features &features);
  [[nodiscard]] bool is_curved() const { return geometry_ != nullptr; }
  void freeze(Index c) { curves_[c].is_frozen = true; }
  [[nodiscard]] Vector<3> on_patch(Index p, const Vector<3> &x) const {
    return foot(p, x).x;
  }
  /// The point of a patch for x. The normal has either direction, and is zero where the
  /// geometry tells none.
  [[nodiscard]] SurfaceFoot foot(Index p, const Vector<3> &x) const;
  /// The unit normal of the surface near x, on the side of `like`; `like` itself where
  /// the geometry tells none.
  [[nodiscard]] Vector<3> normal(Index p, const Vector<3> &x,
                                 const Vector<3> &like) const;
  [[nodiscard]] Vector<3> on_curve(Index c, const Vector<3> &x) const;
  /// The place near x for a vertex on a feature of this dimension; x itself where it is
  /// no place (see is_in_range).
  [[nodiscard]] Vector<3> place(Index dimension, Index lies_on,
                                const Vector<3> &x) const {
    return !is_in_range<3>(x) ? x
           : dimension == 2   ? on_patch(lies_on, x)
           : dimension == 1   ? on_curve(lies_on, x)
                              : x;
  }
  /// From the middle of the segment ab to the feature.
  [[nodiscard]] Vector<3> lift(Index dimension, Index lies_on, const Vector<3> &a,
                               const Vector<3> &b) const {
    const Vector<3> middle = .5 * (a + b);
    return place(dimension, lies_on, middle) - middle;
  }
  /// Whether the middle of the edge ab is farther from the feature than this fraction
  /// of its length, or than the sizes across the feature bear.
  [[nodiscard]] bool strays(Index dimension, Index lies_on, const Vertex<3> &a,
                            const Vertex<3> &b, double hausdorff_number) const;
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
  /// Of the geometry, for every patch and curve; empty where all of its tag count.
  std::vector<std::vector<std::uint8_t>> patches_of_, curves_of_;
};

} // namespace anistar
