#include "surface/facet_shapes.h"

#include "surface/smooth_surface.h"
#include "surface/surface_sag.h"

#include <map>

namespace anistar {
namespace {

/// Nodes and weights of Gauss on [0, 1], exact for degree five.
constexpr std::array<double, 3> nodes{.1127016653792583, .5, .8872983346207417};
constexpr std::array<double, 3> weights{5. / 18, 8. / 18, 5. / 18};

/// Area of a curved triangle, and the volume behind it that it adds to its chords'.
std::pair<double, double> measure_piece(const CurvedPiece &piece,
                                        const Vector<3> &origin) {
  const std::array<Vector<3>, 3> &p = piece.corners;
  const Vector<3> flat = (p[1] - p[0]).cross(p[2] - p[0]);
  if (piece.is_flat())
    return {flat.norm() / 2, 0};
  double area = 0, volume = -(p[0] - origin).dot(flat) / 6;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j < nodes.size(); ++j) { // collapsed to the first corner
      const double s = nodes[i], t = nodes[j];
      const std::array<double, 3> at{1 - s, s * (1 - t), s * t};
      const double weight = weights[i] * weights[j] * s;
      const Vector<3> normal = piece.normal(at);
      area += weight * normal.norm();
      volume += weight *
                (piece.chordal(at) + piece.displacement(at) - origin).dot(normal) / 3;
    }
  return {area, volume};
}

double length_of(const CurvedPiece &segment) {
  const Vector<3> chord = segment.corners[1] - segment.corners[0];
  const Vector<3> &first = segment.offsets[0][1], &second = segment.offsets[1][0];
  double length = 0;
  for (std::size_t q = 0; q < nodes.size(); ++q) {
    const double t = nodes[q], s = 1 - t;
    const Vector<3> along =
        chord + 3 * s * (s - 2 * t) * first + 3 * t * (2 * s - t) * second;
    length += weights[q] * along.norm();
  }
  return length;
}

/// The pieces of a tag are in the order in which the features are.
class InOrder {
public:
  const CurvedPiece &next(const CurvedPieces &pieces, Index tag) {
    return pieces.piece(taken_[tag]++);
  }

private:
  std::map<Index, std::size_t> taken_;
};

void measure_facets(const SurfaceInput &input, const Features &features,
                    const SmoothSurface &surface, FacetShapes &out) {
  InOrder order;
  for (std::size_t f = 0; f < input.facets.size(); ++f) {
    const Index tag = input.facet_tags[f];
    CurvedPiece piece = order.next(*surface.surface(tag), tag);
    if (features.patches[features.facet_patch[f]].is_frozen)
      for (auto &row : piece.offsets)
        row.fill(Vector<3>::Zero());
    std::tie(out.measure[f], out.bulge[f]) = measure_piece(piece, input.points.front());
  }
}

void measure_edges(const SurfaceInput &input, const Features &features,
                   const SmoothSurface &surface, FacetShapes &out) {
  std::map<std::array<Index, 2>, double> length;
  InOrder order;
  for (const RidgeSegment &ridge : features.ridges) {
    const SurfaceCurve &curve = features.curves[ridge.curve];
    if (!curve.is_given)
      continue;
    const auto [a, b] = ridge.ends;
    length[{std::min(a, b), std::max(a, b)}] =
        length_of(order.next(*surface.ridge(true, curve.tag), curve.tag));
  }
  for (std::size_t e = 0; e < input.edges.size(); ++e) {
    const auto [a, b] = input.edges[e];
    out.edge_length[e] = length.at({std::min(a, b), std::max(a, b)});
  }
}

} // namespace

FacetShapes facet_shapes(const SurfaceInput &input) {
  const SmoothSurface surface(input);
  const Features features = find_features(input);
  FacetShapes out(input.facets.size(), input.edges.size());
  measure_facets(input, features, surface, out);
  measure_edges(input, features, surface, out);
  out.sag = surface_sags(input, features);
  return out;
}

} // namespace anistar
