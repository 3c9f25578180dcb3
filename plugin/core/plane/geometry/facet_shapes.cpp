#include "plane/geometry/facet_shapes.h"

#include "base/predicates.h"
#include "mesh/chord_sag.h"

#include <map>

namespace anistar {
namespace {

/// Nodes and weights of Gauss on [0, 1], exact for degree five.
constexpr std::array<double, 3> nodes{.1127016653792583, .5, .8872983346207417};
constexpr std::array<double, 3> weights{5. / 18, 8. / 18, 5. / 18};

/// Length of segment k of a curve, and the area on its left that it adds to its
/// chord's.
std::pair<double, double> measure_segment(const Curve &curve, std::size_t k,
                                          const Vector<2> &origin) {
  const auto first = static_cast<double>(k);
  double length = 0, area = 0;
  for (std::size_t q = 0; q < nodes.size(); ++q) {
    const Vector<2> along = curve.derivative(first + nodes[q]);
    length += weights[q] * along.norm();
    area += weights[q] * cross(curve.at(first + nodes[q]) - origin, along) / 2;
  }
  const Vector<2> a = curve.at(first) - origin, b = curve.at(first + 1) - origin;
  return {length, area - cross(a, b) / 2};
}

} // namespace

FacetShapes facet_shapes(const GeometryInput &input) {
  const Geometry geometry = make_geometry(input, nullptr);
  std::map<std::pair<Index, Index>, std::size_t> row;
  for (std::size_t k = 0; k < input.facets.size(); ++k)
    row[{input.facets[k][0], input.facets[k][1]}] = k;
  FacetShapes out(input.facets.size());
  for (const Curve &curve : geometry.curves)
    for (std::size_t k = 0; k < curve.n_segments(); ++k) {
      const Index a = curve.vertices[k], b = curve.vertices[k + 1];
      const auto forward = row.find({a, b});
      const bool is_forward = forward != row.end();
      const std::size_t f = is_forward ? forward->second : row.at({b, a});
      if (curve.is_frozen || curve.is_straight(k)) {
        out.measure[f] = (input.points[b] - input.points[a]).norm();
        continue;
      }
      const auto [length, area] = measure_segment(curve, k, geometry.points.front());
      out.measure[f] = length;
      out.bulge[f] = is_forward ? area : -area;
    }
  std::vector<bool> is_smooth(input.points.size());
  for (std::size_t v = 0; v < is_smooth.size(); ++v)
    is_smooth[v] =
        !geometry.is_corner[v]; // of those on facets all but corners have two
  out.sag = polyline_sags<2>(input.points, input.facets, is_smooth);
  return out;
}

} // namespace anistar
