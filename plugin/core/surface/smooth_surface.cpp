#include "surface/smooth_surface.h"

#include "base/range.h"
#include "search/nearest_on.h"

#include <algorithm>
#include <map>
#include <numbers>

namespace anistar {
namespace {

/// A tangent that leaves its chord at a larger angle (its cosine) is no sample of a
/// smooth curve: the edge stays straight.
const double steepest_tangent =
    elementary::sine_cosine(40 * std::numbers::pi / 180).cosine;
/// Chords that leave a tangent by less (radians) are straight: above the noise of
/// coordinates in a text file, below the turn of any sampled curve.
constexpr double straight_turn = 1e-7;
/// A curve lies nearer to its chord than this fraction of it: tangents are no steeper.
constexpr double farthest_from_chord = .25;
constexpr int max_rounds = 8;
/// Rounds end when the foot moves by less than this fraction of the piece.
constexpr double settled = 1e-13;

/// The offset of the control point next to the start of a chord, for a curve that
/// starts along the unit vector t.
Vector<3> control_offset(const Vector<3> &chord, const Vector<3> &t) {
  const double length = chord.norm(), cosine = t.dot(chord) / length;
  const double sine = (chord - t * t.dot(chord)).norm() / length;
  if (cosine < steepest_tangent || sine < straight_turn)
    return Vector<3>::Zero();
  return (t * (2 * length / (1 + cosine)) - chord) / 3;
}

/// The direction in which the normal plane section through a chord starts.
Vector<3> tangent_along(const Vector<3> &chord, const Vector<3> &normal) {
  return (chord - normal * normal.dot(chord)).normalized();
}

/// The tangents of ridges at their points.
class RidgeTangents {
public:
  RidgeTangents(std::span<const Vector<3>> points, const Features &features)
      : points_(points) {
    for (const RidgeSegment &ridge : features.ridges)
      for (std::size_t k = 0; k < 2; ++k)
        beyond_[{ridge.ends[k], ridge.curve}].push_back(ridge.ends[1 - k]);
    for (auto it = beyond_.begin(); it != beyond_.end(); ++it)
      if (features.dimension[it->first.first] != 1)
        it->second.resize(1, none); // corners have no tangent of their own
  }

  /// The unit tangent at a of the segment ab, towards b.
  [[nodiscard]] Vector<3> at(Index a, Index b, Index curve) const {
    if (const auto t = circle_tangent(a, b, curve))
      return *t;
    // at a corner: that of the circle with the tangent of the other end
    const Vector<3> chord = (point(b) - point(a)).normalized();
    if (const auto t = circle_tangent(b, a, curve))
      return 2 * chord.dot(-*t) * chord + *t;
    return chord;
  }

private:
  std::span<const Vector<3>> points_;
  std::map<std::pair<Index, Index>, std::vector<Index>> beyond_;

  [[nodiscard]] const Vector<3> &point(Index v) const { return points_[v]; }

  /// That of the circle through a and its two neighbours on the curve, towards b.
  [[nodiscard]] std::optional<Vector<3>> circle_tangent(Index a, Index b,
                                                        Index curve) const {
    const auto found = beyond_.find({a, curve});
    if (found == beyond_.end() || found->second.size() != 2)
      return std::nullopt;
    const Index before = found->second[found->second[0] == b ? 1 : 0];
    const Vector<3> u = point(a) - point(before), v = point(b) - point(a);
    return (u / u.squaredNorm() + v / v.squaredNorm()).normalized();
  }
};

/// Curves of the edges that lie on ridges, by their ends.
using RidgeCurves = std::map<std::array<Index, 2>, Index>;

std::vector<Box<3>> boxes_of(const std::vector<CurvedPiece> &pieces) {
  std::vector<Box<3>> boxes(pieces.size());
  for (std::size_t k = 0; k < pieces.size(); ++k)
    for (const Vector<3> &x : pieces[k].corners)
      boxes[k].extend(x);
  return boxes;
}

CurvedPiece flat_piece(const std::array<Vector<3>, 3> &corners, Index feature) {
  CurvedPiece piece{corners, {}, feature};
  for (auto &row : piece.offsets)
    row.fill(Vector<3>::Zero());
  return piece;
}

} // namespace

bool CurvedPiece::is_flat() const {
  for (const auto &row : offsets)
    for (const Vector<3> &offset : row)
      if (!offset.isZero(0))
        return false;
  return true;
}

Vector<3> CurvedPiece::displacement(const std::array<double, 3> &w) const {
  Vector<3> sum = Vector<3>::Zero(), middle = Vector<3>::Zero();
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (i != j) {
        sum += 3 * w[i] * w[i] * w[j] * offsets[i][j];
        middle += offsets[i][j];
      }
  return sum + 1.5 * w[0] * w[1] * w[2] * middle;
}

Vector<3> CurvedPiece::chordal(const std::array<double, 3> &w) const {
  return w[0] * corners[0] + w[1] * corners[1] + w[2] * corners[2];
}

Vector<3> CurvedPiece::normal(const std::array<double, 3> &w) const {
  Vector<3> middle = Vector<3>::Zero();
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (i != j)
        middle += offsets[i][j];
  std::array<Vector<3>, 3> partial;
  for (std::size_t k = 0; k < 3; ++k) {
    partial[k] = corners[k] + 1.5 * w[(k + 1) % 3] * w[(k + 2) % 3] * middle;
    for (std::size_t j = 0; j < 3; ++j)
      if (j != k)
        partial[k] += 6 * w[k] * w[j] * offsets[k][j] + 3 * w[j] * w[j] * offsets[j][k];
  }
  return (partial[1] - partial[0]).cross(partial[2] - partial[0]);
}

CurvedPieces::CurvedPieces(std::vector<CurvedPiece> pieces)
    : pieces_(std::move(pieces)), tree_(boxes_of(pieces_)) {}

CurvedPieces::Nearest CurvedPieces::on_piece(const Vector<3> &x, Index k) const {
  const CurvedPiece &piece = pieces_[k];
  const std::array<double, 3> weights = nearest_on(x, piece.corners);
  return {k, weights, (piece.chordal(weights) - x).squaredNorm()};
}

CurvedPieces::Nearest CurvedPieces::nearest(const Vector<3> &x, Index start,
                                            const FeatureSet &among) const {
  Nearest best;
  if (!is_in_range<3>(x)) // nothing would be nearest to it
    throw out_of_range("a point to put on a surface is out of range", x);
  if (start != none)
    best = on_piece(x, start);
  tree_.nearest(x, best.distance, [&](Index item, double) {
    const Index of = pieces_[item].feature;
    if (!among.empty() && among[of] == 0)
      return best.distance;
    const Nearest here = on_piece(x, item);
    // of pieces that share the nearest point, the first: the same for any order
    if (here.distance < best.distance ||
        (here.distance == best.distance && item < best.piece))
      best = here;
    return best.distance;
  });
  return best;
}

Index CurvedPieces::nearest_feature(const Vector<3> &x) const {
  const Nearest at = nearest(x, none, {});
  return pieces_[at.piece].feature;
}

bool CurvedPieces::has_any(const FeatureSet &among) const {
  return std::any_of(pieces_.begin(), pieces_.end(), [&](const CurvedPiece &piece) {
    return among[piece.feature] != 0;
  });
}

CurvedPieces::Approach CurvedPieces::approach(const Vector<3> &x,
                                              const FeatureSet &among) const {
  Vector<3> shift = Vector<3>::Zero();
  Nearest at;
  for (int round = 0; round < max_rounds; ++round) {
    at = nearest(x - shift, at.piece, among);
    const CurvedPiece &piece = pieces_[at.piece];
    const Vector<3> found = piece.displacement(at.weights);
    const double change = (found - shift).squaredNorm();
    shift = found;
    if (change <=
        settled * settled * (piece.corners[1] - piece.corners[0]).squaredNorm())
      break;
  }
  return {at, shift};
}

CurvedPieces::Foot CurvedPieces::project(const Vector<3> &x,
                                         const FeatureSet &among) const {
  const auto [at, shift] = approach(x, among);
  const CurvedPiece &piece = pieces_[at.piece];
  return {piece.chordal(at.weights) + shift, piece.normal(at.weights)};
}

std::optional<CurvedPieces::Place> CurvedPieces::find(const Vector<3> &x,
                                                      double tolerance) const {
  const Nearest nearby = nearest(x, none, {});
  const CurvedPiece &chord = pieces_[nearby.piece];
  if (std::sqrt(nearby.distance) >
      farthest_from_chord * (chord.corners[1] - chord.corners[0]).norm() + tolerance)
    return std::nullopt; // as nearly all points are
  const auto [at, shift] = approach(x, {});
  const CurvedPiece &piece = pieces_[at.piece];
  if (!((piece.chordal(at.weights) + shift - x).norm() <= tolerance))
    return std::nullopt;
  return Place{at.piece, at.weights};
}

const CurvedPieces *SmoothSurface::find(const Tagged &all, Index tag) {
  for (const auto &[key, pieces] : all)
    if (key == tag)
      return &pieces;
  return nullptr;
}

double SmoothSurface::distance_to_ridges(const Vector<3> &x,
                                         const FeatureSet &among) const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto &[tag, pieces] : ridges_)
    if (pieces.has_any(among))
      least = std::min(least, (pieces.project(x, among).x - x).norm());
  return least;
}

SmoothSurface::SmoothSurface(const SurfaceInput &geometry) {
  const Features features = find_features(geometry);
  n_patches_ = features.patches.size();
  n_curves_ = features.curves.size();
  jets_ = fit_jets(geometry.points, geometry.facets, features);
  const auto point = [&](Index v) -> const Vector<3> & { return geometry.points[v]; };
  const RidgeTangents tangents(geometry.points, features);
  std::map<Index, std::vector<CurvedPiece>> surfaces, ridges;
  RidgeCurves curve_of;
  std::vector<RidgeSegment> untagged_segments; // in the order of their pieces
  for (const RidgeSegment &ridge : features.ridges) {
    const auto [a, b] = ridge.ends;
    curve_of[{std::min(a, b), std::max(a, b)}] = ridge.curve;
    CurvedPiece piece = flat_piece({point(a), point(b), point(b)}, ridge.curve);
    piece.offsets[0][1] =
        control_offset(point(b) - point(a), tangents.at(a, b, ridge.curve));
    piece.offsets[1][0] =
        control_offset(point(a) - point(b), tangents.at(b, a, ridge.curve));
    const SurfaceCurve &curve = features.curves[ridge.curve];
    ridges[curve.is_given ? curve.tag : untagged].push_back(piece);
    if (!curve.is_given)
      untagged_segments.push_back(ridge);
  }
  chains_ = RidgeChains(untagged_segments, features.dimension);
  segments_ = features.ridges;
  for (std::size_t f = 0; f < geometry.facets.size(); ++f) {
    const Facet<3> &t = geometry.facets[f];
    CurvedPiece piece =
        flat_piece({point(t[0]), point(t[1]), point(t[2])}, features.facet_patch[f]);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        if (i != j) {
          const Vector<3> chord = point(t[j]) - point(t[i]);
          const auto ridge =
              curve_of.find({std::min(t[i], t[j]), std::max(t[i], t[j])});
          const Jet &jet = jets_.jets[jets_.facet_jets[f][i]];
          piece.offsets[i][j] = control_offset(
              chord, ridge != curve_of.end() ? tangents.at(t[i], t[j], ridge->second)
                                             : tangent_along(chord, jet.normal));
        }
    surfaces[geometry.facet_tags[f]].push_back(piece);
  }
  for (auto &[tag, pieces] : surfaces)
    surfaces_.emplace_back(tag, CurvedPieces(std::move(pieces)));
  for (auto &[tag, pieces] : ridges)
    ridges_.emplace_back(tag, CurvedPieces(std::move(pieces)));
}

} // namespace anistar
