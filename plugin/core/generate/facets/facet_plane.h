#pragma once
// The plane of a polygon in space, and the polygon as it looks along an axis.

#include "base/tensor.h"
#include "mesh/adjacency.h"

#include <cmath>
#include <span>

namespace anistar::generate {

/// A plane through the middle of a loop, with the sum of the cross products of its
/// edges as normal (Newell): the loop turns left around it.
struct FacetPlane {
  Vector<3> middle = Vector<3>::Zero();
  Vector<3> normal = Vector<3>::Zero(); ///< of twice the area of the loop as length

  [[nodiscard]] static FacetPlane of(std::span<const Vector<3>> points,
                                     std::span<const Index> loop) {
    FacetPlane plane;
    const Vector<3> &first = points[loop[0]];
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vector<3> a = points[loop[k]] - first;
      const Vector<3> b = points[loop[(k + 1) % loop.size()]] - first;
      plane.normal += a.cross(b);
      plane.middle += a / static_cast<double>(loop.size());
    }
    plane.middle += first;
    return plane;
  }

  [[nodiscard]] bool has_area() const { return normal.squaredNorm() > 0; }
  [[nodiscard]] double distance(const Vector<3> &x) const {
    return std::abs(normal.dot(x - middle)) / normal.norm();
  }
};

/// Along the axis that is nearest to the normal, towards it: the other two coordinates
/// as they are, so that what is decided about them is decided exactly.
class View {
public:
  explicit View(const Vector<3> &normal) {
    normal.cwiseAbs().maxCoeff(&axis_);
    is_mirrored_ = normal[axis_] < 0;
  }
  [[nodiscard]] Vector<2> operator()(const Vector<3> &x) const {
    return {x[(axis_ + 1) % 3], x[(axis_ + 2) % 3]};
  }
  /// Whether what turns left around the normal turns right in the view.
  [[nodiscard]] bool is_mirrored() const { return is_mirrored_; }

private:
  Eigen::Index axis_ = 0;
  bool is_mirrored_ = false;
};

} // namespace anistar::generate
