#pragma once
// On which side of the plane of a facet the vertices lie, asked once for each.

#include "generate/constrained/mesh/ghost_mesh.h"
#include "generate/constrained/points/exact_points.h"

namespace anistar::generate {

class FacetSide {
public:
  explicit FacetSide(const ExactPoints &points) : points_(points) {}

  void start(const Facet<3> &plane) {
    plane_ = plane;
    asked_.start(points_.size());
    side_.resize(points_.size());
  }
  /// Positive above the plane, from where its triangles appear counter-clockwise.
  [[nodiscard]] Orientation operator()(Index v) {
    if (asked_.visit(v)) {
      const auto [a, b, c] = plane_;
      side_[v] = v == a || v == b || v == c ? Orientation::degenerate
                                            : points_.orientation(a, b, c, v);
    }
    return side_[v];
  }
  [[nodiscard]] bool is_on(Index v) { return (*this)(v) == Orientation::degenerate; }
  [[nodiscard]] bool is_above(Index v) { return (*this)(v) == Orientation::positive; }
  [[nodiscard]] bool is_below(Index v) { return (*this)(v) == Orientation::negative; }

private:
  const ExactPoints &points_;
  Facet<3> plane_{};
  Visits asked_;
  PerVertex<Orientation> side_;
};

} // namespace anistar::generate
