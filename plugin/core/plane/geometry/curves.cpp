#include "plane/geometry/curves.h"

#include "base/predicates.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>

namespace anistar {
namespace {

/// Chains that turn by less (radians) are straight: far above the noise of coordinates
/// in a text file, far below the turn of any sampled curve.
constexpr double straight_turn = 1e-6;
/// A tangent that leaves its chord at a larger angle than this (its cosine) is no
/// sample of a smooth curve: the segment stays straight, and the curve within a fifth
/// of its length.
const double steepest_tangent =
    elementary::sine_cosine(40 * std::numbers::pi / 180).cosine;
/// Where an arc meets its tangent line, the polyline turns by half the turn between two
/// chords of the arc; a turn well beyond that is a corner.
constexpr double tangent_turn_factor = 1.5;
/// A turn of this fraction of the ridge angle is a corner when it is this many times as
/// large as those beside it.
constexpr double weak_fraction = 1. / 3, standing_out = 3;
/// Bisections for the middle of an edge: to a billionth of it.
constexpr int n_bisections = 30;
/// Pieces of an edge between which its distance from the curve is looked at.
constexpr double n_pieces = 4;

double turn(const Vector<2> &u, const Vector<2> &v) {
  return std::abs(elementary::angle_of(cross(u, v), u.dot(v)));
}

/// Tangent at b of the circle through a, b, c.
Vector<2> circle_tangent(const Vector<2> &a, const Vector<2> &b, const Vector<2> &c) {
  const Vector<2> u = b - a, v = c - b;
  return (u / u.squaredNorm() + v / v.squaredNorm()).normalized();
}

/// The tangent at the far end of a chord that a circle with tangent t here would have.
Vector<2> reflected(const Vector<2> &t, const Vector<2> &chord) {
  const Vector<2> c = chord.normalized();
  return 2 * t.dot(c) * c - t;
}

struct Link { ///< a facet with what lies beside it, from `from` to `to`
  Index from, to, tag, left, right;
  [[nodiscard]] Link reversed() const { return {to, from, tag, right, left}; }
  [[nodiscard]] bool continues(const Link &other) const {
    return tag == other.tag && left == other.left && right == other.right;
  }
};

/// What lies to the left of the directed facets.
class Sides {
public:
  explicit Sides(const GeometryInput &input) {
    std::vector<bool> on_facet(input.points.size(), false);
    for (const Facet<2> &facet : input.facets)
      for (Index v : facet)
        on_facet[v] = true;
    for (std::size_t c = 0; c < input.cells.size(); ++c)
      for (std::size_t i = 0; i < 3; ++i) {
        const Facet<2> e = facet_of<2>(input.cells[c], i);
        if (on_facet[e[0]] && on_facet[e[1]])
          left_[{e[0], e[1]}] = input.cell_tags[c];
      }
  }
  [[nodiscard]] bool has_cell(Index a, Index b) const { return left_.contains({a, b}); }
  [[nodiscard]] Index left(Index a, Index b) const {
    const auto found = left_.find({a, b});
    return found == left_.end() ? no_region : found->second;
  }

private:
  std::map<std::pair<Index, Index>, Index> left_;
};

std::vector<Link> make_links(const GeometryInput &input) {
  const Sides sides(input);
  std::vector<Link> links;
  for (std::size_t k = 0; k < input.facets.size(); ++k) {
    const auto [a, b] = input.facets[k];
    if (!sides.has_cell(a, b) && !sides.has_cell(b, a))
      throw std::invalid_argument("facet " + std::to_string(k) +
                                  " is not a facet of any cell");
    links.push_back({a, b, input.facet_tags[k], sides.left(a, b), sides.left(b, a)});
  }
  return links;
}

/// Facets at every point, as (link, leaves it).
using Incidence = std::vector<std::vector<std::pair<std::size_t, bool>>>;

Incidence incidence(const std::vector<Link> &links, std::size_t n_points) {
  Incidence at(n_points);
  for (std::size_t k = 0; k < links.size(); ++k) {
    at[links[k].from].emplace_back(k, true);
    at[links[k].to].emplace_back(k, false);
  }
  return at;
}

struct Chains {
  const GeometryInput &input;
  std::vector<Link> links = make_links(input);
  Incidence at = incidence(links, input.points.size());

  [[nodiscard]] Vector<2> point(Index v) const { return input.points[v]; }
  [[nodiscard]] Link outgoing(Index v, std::size_t n) const {
    const auto [k, leaves] = at[v][n];
    return leaves ? links[k] : links[k].reversed();
  }
  /// The turn of the chain at v, a vertex with two facets.
  [[nodiscard]] double turn_at(Index v) const {
    const Link in = outgoing(v, 0).reversed(), out = outgoing(v, 1);
    return turn(point(v) - point(in.from), point(out.to) - point(v));
  }
  [[nodiscard]] bool is_straight_at(Index v) const {
    return at[v].size() == 2 && turn_at(v) < straight_turn;
  }
  /// The facet that leaves v along link n lies in a straight run.
  [[nodiscard]] bool in_straight_run(Index v, std::size_t n) const {
    return is_straight_at(v) || is_straight_at(outgoing(v, n).to);
  }
  [[nodiscard]] bool is_corner(Index v) const {
    const auto &here = at[v];
    if (here.size() != 2)
      return !here.empty();
    if (!outgoing(v, 0).reversed().continues(outgoing(v, 1)))
      return true;
    const double angle = turn_at(v);
    if (angle >= input.shape.sharp_turn() * std::numbers::pi / 180)
      return true;
    if (input.shape.is_polyhedron() || angle < straight_turn)
      return false;
    const bool straight[2] = {in_straight_run(v, 0), in_straight_run(v, 1)};
    if (straight[0] && straight[1])
      return true;
    for (std::size_t n : {0u, 1u})
      if (straight[1 - n]) { // a line meets a curve along link n
        const Index next = outgoing(v, n).to;
        if (at[next].size() != 2 || joins_straight_run(next) ||
            angle > tangent_turn_factor * turn_at(next))
          return true;
      }
    return stands_out(v, angle);
  }
  /// Between two curves. The turns at three points of an arc never differ as much,
  /// however they are spaced.
  [[nodiscard]] bool stands_out(Index v, double angle) const {
    if (angle < weak_fraction * input.shape.sharp_turn() * std::numbers::pi / 180)
      return false;
    for (std::size_t n : {0u, 1u}) {
      const Index next = outgoing(v, n).to;
      if (at[next].size() != 2 || angle < standing_out * turn_at(next))
        return false;
    }
    return true;
  }
  [[nodiscard]] bool joins_straight_run(Index v) const {
    return in_straight_run(v, 0) || in_straight_run(v, 1);
  }
};

} // namespace

void Curve::fit(std::vector<Vector<2>> points, const Projection *projection) {
  points_ = std::move(points);
  projection_ = projection;
  const std::size_t n = n_segments();
  std::vector<Vector<2>> chord(n);
  for (std::size_t k = 0; k < n; ++k)
    chord[k] = points_[k + 1] - points_[k];
  is_chord_.assign(n, false);
  mark_straight_runs(chord);
  const std::vector<Vector<2>> tangent = tangents(chord);
  // the magnitude with which a cubic follows a circle to sixth order
  const auto hermite = [](const Vector<2> &t, const Vector<2> &c) -> Vector<2> {
    return t * (2 * c.norm() / (1 + t.dot(c) / c.norm()));
  };
  start_.resize(n);
  end_.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Vector<2> direction = chord[k].normalized();
    if (std::min(tangent[k].dot(direction), tangent[k + 1].dot(direction)) <
        steepest_tangent)
      is_straight_[k] = true;
    start_[k] = hermite(tangent[k], chord[k]);
    end_[k] = hermite(tangent[k + 1], chord[k]);
  }
}

void Curve::mark_straight_runs(const std::vector<Vector<2>> &chord) {
  const std::size_t n = n_segments();
  is_straight_.assign(n, n == 1);
  for (std::size_t k = 0; k < n; ++k)
    if (is_joint(k) && turn(chord[before(k)], chord[k]) < straight_turn)
      is_straight_[k] = is_straight_[before(k)] = true;
}

std::vector<Vector<2>> Curve::tangents(const std::vector<Vector<2>> &chord) const {
  const std::size_t n = n_segments();
  std::vector<Vector<2>> tangent(n + 1);
  for (std::size_t k = 0; k < n; ++k)
    if (is_joint(k)) {
      const std::size_t b = before(k);
      if (is_straight_[b])
        tangent[k] = chord[b].normalized();
      else if (is_straight_[k])
        tangent[k] = chord[k].normalized();
      else
        tangent[k] = circle_tangent(points_[k] - chord[b], points_[k], points_[k + 1]);
    }
  if (is_loop) {
    tangent[n] = tangent[0];
  } else {
    const Vector<2> only = chord[0].normalized();
    tangent[0] = n > 1 ? reflected(tangent[1], chord[0]) : only;
    tangent[n] = n > 1 ? reflected(tangent[n - 1], chord[n - 1]) : only;
  }
  return tangent;
}

Curve::OnSegment Curve::on_segment(double t) const {
  const double last = static_cast<double>(n_segments()) - 1;
  const double whole = std::clamp(std::floor(t), 0., last);
  return {static_cast<std::size_t>(whole), t - whole};
}

Vector<2> Curve::at(double t) const {
  const auto [k, s] = on_segment(t);
  if (s == 0)
    return points_[k];
  if (s == 1)
    return points_[k + 1];
  Vector<2> x = (1 - s) * points_[k] + s * points_[k + 1];
  if (is_straight_[k]) {
    // axis-parallel runs stay on their coordinate to the last bit
    for (int i = 0; i < 2; ++i)
      if (points_[k][i] == points_[k + 1][i])
        x[i] = points_[k][i];
  } else {
    const Vector<2> chord = points_[k + 1] - points_[k];
    x += s * (1 - s) * ((1 - s) * (start_[k] - chord) - s * (end_[k] - chord));
  }
  return projection_ && *projection_ && !is_chord_[k] ? (*projection_)(x, tag) : x;
}

Vector<2> Curve::on_polyline(double t) const {
  const auto [k, s] = on_segment(t);
  return points_[k] + s * (points_[k + 1] - points_[k]);
}

Vector<2> Curve::derivative(double t) const {
  const auto [k, s] = on_segment(t);
  const Vector<2> chord = points_[k + 1] - points_[k];
  if (is_straight_[k])
    return chord;
  return chord + (1 - s) * (1 - 3 * s) * (start_[k] - chord) -
         s * (2 - 3 * s) * (end_[k] - chord);
}

namespace {

/// Corners on no facet, with the region that they lie in.
std::vector<FreePoint> free_points(const GeometryInput &input, const Chains &chains) {
  std::vector<Index> region(input.points.size(), no_region);
  std::vector<FreePoint> found;
  for (std::size_t c = 0; c < input.cells.size(); ++c)
    for (Index v : input.cells[c])
      region[v] = input.cell_tags[c];
  std::vector<Index> corners(input.corners.begin(), input.corners.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  for (Index v : corners)
    if (chains.at[v].empty())
      found.push_back({v, region[v]});
  return found;
}

/// The facets on no curve yet are followed from corner to corner, or around a loop.
class Tracer {
public:
  Tracer(const GeometryInput &input, const Chains &chains,
         const std::vector<bool> &is_corner)
      : input_(input), chains_(chains), is_corner_(is_corner),
        is_done_(chains.links.size(), false) {}

  /// Whether the facet along link n of a vertex is on a curve that was traced.
  [[nodiscard]] bool is_done(Index from, std::size_t n) const {
    return is_done_[chains_.at[from][n].first];
  }
  /// The curve that leaves a vertex along link n.
  [[nodiscard]] Curve trace(Index from, std::size_t n, const Projection *projection) {
    Curve curve;
    Link link = chains_.outgoing(from, n);
    curve.tag = link.tag;
    curve.left = link.left;
    curve.right = link.right;
    curve.is_frozen = input_.shape.is_frozen(link.tag);
    curve.vertices = {from};
    curve.is_loop = !is_corner_[from];
    std::size_t k = chains_.at[from][n].first;
    for (;;) {
      is_done_[k] = true;
      curve.vertices.push_back(link.to);
      if (is_corner_[link.to] || link.to == from)
        break;
      const std::size_t other = chains_.at[link.to][0].first == k ? 1 : 0;
      k = chains_.at[link.to][other].first;
      link = chains_.outgoing(link.to, other);
    }
    std::vector<Vector<2>> points;
    for (Index v : curve.vertices)
      points.push_back(chains_.point(v));
    curve.fit(std::move(points), projection);
    return curve;
  }

private:
  const GeometryInput &input_;
  const Chains &chains_;
  const std::vector<bool> &is_corner_;
  std::vector<bool> is_done_;
};

} // namespace

Geometry make_geometry(const GeometryInput &input, const Projection *projection) {
  const Chains chains{input};
  Geometry geometry;
  geometry.points.assign(input.points.begin(), input.points.end());
  geometry.is_corner.assign(input.points.size(), false);
  for (Index v : input.corners)
    geometry.is_corner.at(v) = true;
  for (std::size_t v = 0; v < input.points.size(); ++v)
    if (chains.is_corner(static_cast<Index>(v)))
      geometry.is_corner[v] = true;
  geometry.free_points = free_points(input, chains);
  Tracer tracer(input, chains, geometry.is_corner);
  for (bool at_corner : {true, false}) // what is left after the corners is closed
    for (std::size_t v = 0; v < input.points.size(); ++v)
      for (std::size_t n = 0; n < chains.at[v].size(); ++n)
        if (const auto from = static_cast<Index>(v);
            geometry.is_corner[v] == at_corner && !tracer.is_done(from, n))
          geometry.curves.push_back(tracer.trace(from, n, projection));
  return geometry;
}

double middle(const Curve &curve, double t0, double t1) {
  const Vector<2> a = curve.at(t0), b = curve.at(t1);
  double low = t0, high = t1;
  for (int step = 0; step < n_bisections; ++step) {
    const double t = .5 * (low + high);
    const Vector<2> x = curve.at(t);
    ((x - a).squaredNorm() < (x - b).squaredNorm() ? low : high) = t;
  }
  return .5 * (low + high);
}

double relative_sagitta(const Curve &curve, double t0, double t1) {
  const Vector<2> a = curve.at(t0), chord = curve.at(t1) - a;
  const double length = chord.norm();
  if (!(length > 0))
    return std::numeric_limits<double>::infinity();
  double worst = 0;
  const auto consider = [&](double t) {
    const Vector<2> r = curve.at(t) - a;
    const double along = r.dot(chord) / length;
    const double past = std::max({0., -along, along - length});
    worst =
        std::max(worst, elementary::length(cross(chord, r) / length, past) / length);
  };
  for (double k = 1; k < n_pieces; ++k)
    consider(t0 + (t1 - t0) * k / n_pieces);
  // an edge over many points of the geometry is compared with all of them
  for (double t = std::floor(t0) + 1; t < t1; ++t)
    consider(t);
  return worst;
}

} // namespace anistar
