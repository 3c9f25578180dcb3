#include "plane/geometry/protection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace anistar {
namespace {

/// Angles below this, in the metric of the corner, are sharp: the first vertices of the
/// two legs are nearer to each other than to the corner. The slack leaves the corners
/// of a regular triangle alone.
constexpr double sharp_angle = std::numbers::pi / 3 * (1 - 1e-9);
/// Radii tried, as powers of two, within the bounds of a unit edge.
constexpr int n_radii = 32;
/// |ln l| of a unit edge is at most this.
constexpr double unit_deviation = std::numbers::ln2 / 2;
/// Nothing shorter than this is left of a leg beyond its ball.
constexpr double least_rest = .5;
/// Between radii that serve as well, the one nearer to 1.
constexpr double preference = 1e-3;
/// They leave nothing of an interval but round-off.
constexpr int n_bisections = 60;

/// A curve as seen from a corner at one of its ends.
struct Leg {
  std::size_t curve;
  bool leaves; ///< the corner is where the curve begins
  double angle = 0;
  Vector<2> direction = Vector<2>::Zero();
  std::size_t group = 0; ///< legs with a common ball
};

/// Where a ball cuts a leg.
struct Cut {
  double parameter, length;
};

/// The legs at one corner.
class CornerBall {
public:
  CornerBall(const Geometry &geometry, std::span<const LengthTable> lengths,
             const Run &run, const Vector<2> &x, const SymmetricTensor<2> &M,
             std::vector<Leg> legs)
      : geometry_(geometry), lengths_(lengths), run_(run), x_(x), M_(M),
        legs_(std::move(legs)) {
    for (Leg &leg : legs_) {
      const double s = std::min(1., table(leg).total());
      leg.direction = at(leg, parameter(leg, s)) - x_;
      leg.angle = elementary::angle_of(leg.direction[1], leg.direction[0]);
    }
    std::sort(legs_.begin(), legs_.end(),
              [](const Leg &a, const Leg &b) { return a.angle < b.angle; });
    join_sharp_sectors();
  }

  [[nodiscard]] const std::vector<Leg> &legs() const { return legs_; }
  /// Legs with a common ball, two or more.
  [[nodiscard]] std::vector<std::vector<Leg>> groups() const {
    std::vector<std::vector<Leg>> found(legs_.size());
    for (const Leg &leg : legs_)
      found[leg.group].push_back(leg);
    std::erase_if(found, [](const auto &group) { return group.size() < 2; });
    return found;
  }

  /// The cuts of a group by the best ball, none when no ball serves all its legs.
  /// @param shared whether another ball takes its part of the same leg
  template <class Shared>
  [[nodiscard]] std::vector<Cut> cuts(const std::vector<Leg> &group,
                                      Shared shared) const {
    double natural = unit_deviation;
    std::vector<double> radii{1};
    for (const Leg &leg : group) {
      const double l = table(leg).total();
      natural = std::max(natural, deviation(l / std::max(1., std::round(l))));
      radii.push_back(distance(leg, given_cut(leg)));
    }
    for (int k = -n_radii; k <= n_radii; ++k)
      radii.push_back(elementary::exp2(.5 * k / n_radii));
    std::vector<Cut> best;
    double least = natural;
    for (double radius : radii) {
      std::vector<Cut> found;
      double worst = preference * deviation(radius);
      for (const Leg &leg : group) {
        const auto [cut, cost] = cut_at(leg, radius, shared(leg));
        found.push_back(cut);
        worst = std::max(worst, cost + preference * deviation(radius));
      }
      if (worst < least) {
        least = worst;
        best = std::move(found);
      }
    }
    return best;
  }

private:
  const Geometry &geometry_;
  std::span<const LengthTable> lengths_;
  const Run &run_;
  Vector<2> x_;
  SymmetricTensor<2> M_;
  std::vector<Leg> legs_; ///< counter-clockwise

  [[nodiscard]] static double deviation(double length) {
    return std::abs(elementary::log(length));
  }
  [[nodiscard]] const Curve &curve(const Leg &leg) const {
    return geometry_.curves[leg.curve];
  }
  [[nodiscard]] const LengthTable &table(const Leg &leg) const {
    return lengths_[leg.curve];
  }
  [[nodiscard]] Vector<2> at(const Leg &leg, double t) const {
    return curve(leg).at(t);
  }
  /// The parameter at metric length s from the corner.
  [[nodiscard]] double parameter(const Leg &leg, double s) const {
    return table(leg).parameter_at(leg.leaves ? s : table(leg).total() - s);
  }
  [[nodiscard]] double near_end(const Leg &leg) const {
    return leg.leaves ? 0 : static_cast<double>(curve(leg).n_segments());
  }
  [[nodiscard]] double far_end(const Leg &leg) const {
    return leg.leaves ? static_cast<double>(curve(leg).n_segments()) : 0;
  }
  /// Where a leg can be cut without a choice: at its other end, or, when it is frozen,
  /// at its first point.
  [[nodiscard]] double given_cut(const Leg &leg) const {
    return curve(leg).is_frozen ? near_end(leg) + (leg.leaves ? 1 : -1) : far_end(leg);
  }
  [[nodiscard]] double distance(const Leg &leg, double t) const {
    return std::sqrt(quadratic<2>(M_, at(leg, t) - x_));
  }

  void join_sharp_sectors() {
    const std::size_t n = legs_.size();
    for (std::size_t k = 0; k < n; ++k)
      legs_[k].group = k;
    for (std::size_t k = 0; k < n && n > 1; ++k) {
      const Leg &leg = legs_[k], &next = legs_[(k + 1) % n];
      const Index region = leg.leaves ? curve(leg).left : curve(leg).right;
      if (region == no_region || angle_between(leg, next) >= sharp_angle)
        continue;
      const std::size_t from = next.group, to = leg.group;
      for (Leg &other : legs_)
        if (other.group == from)
          other.group = to;
    }
  }

  /// The angle of a sector in the metric of the corner, in [0, 2 pi).
  [[nodiscard]] double angle_between(const Leg &a, const Leg &b) const {
    const double sine = std::sqrt(determinant<2>(M_)) * cross(a.direction, b.direction);
    const double cosine = product<2>(M_, a.direction).dot(b.direction);
    const double angle = elementary::angle_of(sine, cosine);
    return angle < 0 ? angle + 2 * std::numbers::pi : angle;
  }

  /// Where a leg first reaches a distance from the corner, and how far the edges of the
  /// leg would be from unit length.
  [[nodiscard]] std::pair<Cut, double> cut_at(const Leg &leg, double radius,
                                              bool is_shared) const {
    constexpr double never = std::numeric_limits<double>::infinity();
    const bool is_given = distance(leg, given_cut(leg)) == radius;
    if (curve(leg).is_frozen)
      return {{given_cut(leg), 0}, is_given ? 0 : never};
    const double whole = table(leg).total();
    const bool is_whole = is_given && !is_shared;
    const Cut cut = is_whole ? Cut{far_end(leg), whole} : first_at(leg, radius);
    if (relative_sagitta(curve(leg), std::min(near_end(leg), cut.parameter),
                         std::max(near_end(leg), cut.parameter)) > run_.hausdorff.curve)
      return {cut, never};
    if (is_whole)
      return {cut, deviation(whole)};
    const double rest = whole - (is_shared ? 2 : 1) * cut.length;
    if (rest < least_rest)
      return {cut, never};
    return {cut, std::max(deviation(cut.length),
                          deviation(rest / std::max(1., std::round(rest))))};
  }

  [[nodiscard]] Cut first_at(const Leg &leg, double radius) const {
    const std::vector<double> &knots = table(leg).parameter;
    const std::size_t n = knots.size();
    double inside = near_end(leg), outside = far_end(leg);
    for (std::size_t k = 1; k < n; ++k) {
      run_.monitor.insist(0);
      const double t = knots[leg.leaves ? k : n - 1 - k];
      if (distance(leg, t) >= radius) {
        outside = t;
        break;
      }
      inside = t;
    }
    for (int step = 0; step < n_bisections; ++step) {
      run_.monitor.insist(0);
      const double t = .5 * (inside + outside);
      (distance(leg, t) < radius ? inside : outside) = t;
    }
    const double s = table(leg).length_at(outside);
    return {outside, leg.leaves ? s : table(leg).total() - s};
  }
};

/// The legs at every point of the geometry.
std::vector<std::vector<Leg>> legs_at_points(const Geometry &geometry) {
  std::vector<std::vector<Leg>> legs(geometry.points.size());
  for (std::size_t c = 0; c < geometry.curves.size(); ++c) {
    const Curve &curve = geometry.curves[c];
    if (curve.is_loop)
      continue;
    legs[curve.vertices.front()].push_back({c, true});
    legs[curve.vertices.back()].push_back({c, false});
  }
  return legs;
}

} // namespace

Protection protect_corners(const Geometry &geometry, const Background<2> &background,
                           std::span<const LengthTable> lengths, const Run &run) {
  Protection out;
  out.shells.resize(geometry.curves.size());
  std::vector<CornerBall> corners;
  std::vector<std::array<bool, 2>> is_sharp(geometry.curves.size(), {false, false});
  const auto legs = legs_at_points(geometry);
  Index cell = none;
  for (std::size_t v = 0; v < legs.size(); ++v) {
    if (legs[v].size() < 2)
      continue;
    const Vector<2> &x = geometry.points[v];
    corners.emplace_back(geometry, lengths, run, x, background.metric(x, cell),
                         legs[v]);
    for (const auto &group : corners.back().groups())
      for (const Leg &leg : group)
        is_sharp[leg.curve][leg.leaves ? 0 : 1] = true;
  }
  for (const CornerBall &corner : corners)
    for (const std::vector<Leg> &group : corner.groups()) {
      const std::vector<Cut> cuts = corner.cuts(group, [&](const Leg &leg) {
        return is_sharp[leg.curve][leg.leaves ? 1 : 0];
      });
      for (std::size_t k = 0; k < cuts.size(); ++k) {
        Shells &shells = out.shells[group[k].curve];
        (group[k].leaves ? shells.first : shells.last) = {cuts[k].parameter,
                                                          out.n_balls};
      }
      out.given_up += cuts.empty();
      out.n_balls += !cuts.empty();
    }
  return out;
}

} // namespace anistar
