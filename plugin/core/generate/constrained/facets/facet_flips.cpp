#include "generate/constrained/facets/facet_flips.h"

#include <algorithm>

namespace anistar::generate {
namespace {

using Quad = FacetTriangles::Quad;

/// Flips come to an end, even where rounded angles would have them go round in circles.
constexpr Index max_tries = 6;
/// The share of its area that each of the two triangles of a flipped quadrilateral has
/// at least, far above what rounding makes of a straight corner.
constexpr double least_share = 1e-9;
/// How clearly two opposite angles must add up to more than 180 degrees, as a sine.
constexpr double clearly = 1e-9;

/// Whether both diagonals lie inside; the quadrilateral may be slightly bent.
bool is_convex(const ExactPoints &points, const Quad &quad) {
  const Vector<3> &a = points.rounded(quad.from), &b = points.rounded(quad.to),
                  &c = points.rounded(quad.left), &d = points.rounded(quad.right);
  const Vector<3> normal = (a - c).cross(b - c) + (b - d).cross(a - d);
  const double least = least_share * normal.squaredNorm();
  return (a - c).cross(d - c).dot(normal) > least &&
         (d - c).cross(b - c).dot(normal) > least;
}

/// Sine and cosine of the angle at a corner, times the lengths of its sides.
struct Angle {
  double sine, cosine;
  Angle(const Vector<3> &one, const Vector<3> &other)
      : sine(one.cross(other).norm()), cosine(one.dot(other)) {}
};

/// Whether the angles opposite the edge add up to more than 180 degrees.
bool is_delaunay_flip(const ExactPoints &points, const Quad &quad) {
  const Vector<3> &a = points.rounded(quad.from), &b = points.rounded(quad.to),
                  &c = points.rounded(quad.left), &d = points.rounded(quad.right);
  const Angle left(a - c, b - c), right(a - d, b - d);
  const double sides =
      (a - c).norm() * (b - c).norm() * (a - d).norm() * (b - d).norm();
  return left.sine * right.cosine + left.cosine * right.sine < -clearly * sides;
}

} // namespace

/// Whether a missing edge should be the other diagonal of its quadrilateral; asked too
/// often for the same one the answer is no.
bool FacetFlips::should_flip(Index edge) {
  const auto quad = facets_.quad(edge);
  if (!quad || facets_.find(quad->left, quad->right) != none ||
      !is_convex(points_, *quad))
    return false;
  if (!mesh_.find_edge(quad->left, quad->right) && !is_delaunay_flip(points_, *quad))
    return false;
  const Index tries = std::max(tries_.find(quad->left, quad->right), 0);
  tries_.put(quad->left, quad->right, tries + 1);
  return tries < max_tries;
}

std::vector<Index> FacetFlips::flip_required(Index edge, ExactPoints &points) {
  if (!should_flip(edge))
    return {};
  ++n_flips_;
  return facets_.flip_required(edge, points);
}

void FacetFlips::flip_missing_edges() {
  std::vector<Index> waiting;
  for (Index edge = static_cast<Index>(facets_.edges().size()) - 1; edge >= 0; --edge)
    if (!facets_.is_required(edge))
      waiting.push_back(edge);
  while (!waiting.empty()) {
    const Index edge = waiting.back();
    waiting.pop_back();
    const FacetTriangles::Edge e = facets_.edges()[edge];
    if (!e.is_alive || mesh_.find_edge(e.from, e.to) || !should_flip(edge))
      continue;
    const Index diagonal = facets_.flip(edge);
    ++n_flips_;
    for (const auto &[k, i] : facets_.sides(diagonal))
      for (const Index side : facets_.triangles()[k].edges)
        if (side != diagonal && !facets_.is_required(side))
          waiting.push_back(side);
    waiting.push_back(diagonal);
  }
}

} // namespace anistar::generate
