#include "plane/geometry/facet_bulges.h"

#include "base/predicates.h"

#include <map>
#include <utility>

namespace anistar {
namespace {

/// The height of segment k of a curve over the middle of its chord, on the left.
double height(const Curve &curve, std::size_t k) {
  const auto first = static_cast<double>(k);
  const Vector<2> a = curve.at(first), b = curve.at(first + 1), chord = b - a;
  const Vector<2> rise = curve.at(first + .5) - .5 * (a + b);
  return cross(chord, rise) / chord.norm();
}

} // namespace

std::vector<FacetBulge<2>> facet_bulges(const GeometryInput &input) {
  const Geometry geometry = make_geometry(input, nullptr);
  std::map<std::pair<Index, Index>, FacetBulge<2>> of_segment;
  for (const Curve &curve : geometry.curves)
    for (std::size_t k = 0; k < curve.n_segments(); ++k)
      if (!curve.is_frozen && !curve.is_straight(k)) {
        const Index a = curve.vertices[k], b = curve.vertices[k + 1];
        const double h = height(curve, k);
        of_segment[{a, b}] = {h};
        of_segment[{b, a}] = {-h};
      }
  std::vector<FacetBulge<2>> bulges(input.facets.size(), FacetBulge<2>{});
  for (std::size_t f = 0; f < bulges.size(); ++f) {
    const auto known = of_segment.find({input.facets[f][0], input.facets[f][1]});
    if (known != of_segment.end())
      bulges[f] = known->second;
  }
  return bulges;
}

} // namespace anistar
