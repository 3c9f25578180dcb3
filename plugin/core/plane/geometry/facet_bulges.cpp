#include "plane/geometry/facet_bulges.h"

#include "base/predicates.h"

#include <map>
#include <utility>

namespace anistar {
namespace {

/// Relative to the chord.
constexpr double straight = 1e-9;

} // namespace

double chord_height(const Curve &curve, double t0, double t1) {
  const Vector<2> a = curve.at(t0), b = curve.at(t1), chord = b - a;
  const Vector<2> rise = curve.at(.5 * (t0 + t1)) - .5 * (a + b);
  const double length = chord.norm(), height = cross(chord, rise) / length;
  return std::abs(height) <= straight * length ? 0 : height;
}

std::vector<FacetBulge<2>> facet_bulges(const GeometryInput &input) {
  const Geometry geometry = make_geometry(input, nullptr);
  std::map<std::pair<Index, Index>, FacetBulge<2>> of_segment;
  for (const Curve &curve : geometry.curves)
    for (std::size_t k = 0; k < curve.n_segments(); ++k)
      if (!curve.is_frozen && !curve.is_straight(k)) {
        const Index a = curve.vertices[k], b = curve.vertices[k + 1];
        const auto first = static_cast<double>(k);
        const double h = chord_height(curve, first, first + 1);
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
