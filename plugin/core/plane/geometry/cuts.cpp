#include "plane/geometry/cuts.h"

#include "base/errors.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace anistar {
namespace {

/// Parameters this near to a point of the geometry are there: a retreat, which may put
/// a vertex on that point, would leave an edge without length.
constexpr double at_point = 1e-7;

/// Chords are bisected at most this often to meet the Hausdorff bound.
constexpr int max_bisections = 16;
/// And a chord is cut into at most so many, and so many for each of the points of the
/// geometry that it spans. A smooth curve needs a few, a kink one for every bisection:
/// more, and the projection tears the curve apart.
constexpr std::size_t most_cuts = 1024, most_cuts_at_point = 8;

/// Cuts a curve into chords that keep to it.
class Bisection {
public:
  Bisection(const Curve &curve, const Run &run) : curve_(curve), run_(run) {}

  /// Adds the ends of the chords over [t0, t1].
  void cut(double t0, double t1) {
    first_ = cuts_.size();
    most_ = first_ + most_cuts + most_cuts_at_point * static_cast<std::size_t>(t1 - t0);
    halve(t0, t1, 0);
  }
  [[nodiscard]] std::vector<double> take_cuts() { return std::move(cuts_); }

private:
  const Curve &curve_;
  const Run &run_;
  std::vector<double> cuts_{0};
  std::size_t first_ = 0, most_ = 0; ///< of the chord that is cut

  void halve(double t0, double t1, int depth) {
    run_.monitor.insist(cuts_.size());
    if (cuts_.size() > most_)
      throw MeshingError("an edge along the curve with tag " +
                             std::to_string(curve_.tag) + " was cut " +
                             std::to_string(most_ - first_) +
                             " times and still strays from it by more than " +
                             std::to_string(run_.hausdorff.curve) +
                             " of its length: the geometry, or project, jumps",
                         curve_.at(t0));
    if (depth < max_bisections &&
        relative_sagitta(curve_, t0, t1) > run_.hausdorff.curve) {
      const double t = middle(curve_, t0, t1);
      halve(t0, t, depth + 1);
      halve(t, t1, depth + 1);
    } else {
      cuts_.push_back(t1);
    }
  }
};

/// Whether the points of the geometry between two of a curve keep to their chord.
bool keeps_to_chord(const Curve &curve, std::size_t first, std::size_t last,
                    double hausdorff) {
  const auto at = [&](std::size_t k) { return curve.at(static_cast<double>(k)); };
  const Vector<2> a = at(first), chord = at(last) - a;
  const double square = chord.squaredNorm();
  for (std::size_t k = first + 1; k < last; ++k) {
    const Vector<2> r = at(k) - a;
    const double along = r.dot(chord);
    if (!(along > 0 && along < square &&
          std::abs(cross(chord, r)) <= hausdorff * square))
      return false;
  }
  return true;
}

void halve_chord(const Curve &curve, std::size_t first, std::size_t last,
                 double hausdorff, std::vector<double> &cuts) {
  if (last - first == 1 || keeps_to_chord(curve, first, last, hausdorff)) {
    cuts.push_back(static_cast<double>(last));
    return;
  }
  const std::size_t middle = first + (last - first) / 2;
  halve_chord(curve, first, middle, hausdorff, cuts);
  halve_chord(curve, middle, last, hausdorff, cuts);
}

} // namespace

std::vector<double> unit_cuts(const Curve &curve, const LengthTable &table,
                              const Shells &shells, const Run &run) {
  const double end = static_cast<double>(curve.n_segments());
  std::vector<double> unit{0};
  if (curve.is_frozen)
    return own_points(curve);
  if (shells.first)
    unit.push_back(shells.first->parameter);
  const double fewest = curve.is_loop ? 3 : 1;
  const double begin = table.length_at(unit.back());
  const double length =
      table.length_at(shells.last ? shells.last->parameter : end) - begin;
  const double n = std::max(fewest, std::round(length));
  for (double k = 1; k < n; ++k)
    unit.push_back(table.parameter_at(begin + length * k / n));
  if (shells.last)
    unit.push_back(shells.last->parameter);
  unit.push_back(end);
  unit.erase(std::unique(unit.begin(), unit.end()), unit.end());
  Bisection bisection(curve, run);
  for (std::size_t k = 0; k + 1 < unit.size(); ++k)
    bisection.cut(unit[k], unit[k + 1]);
  std::vector<double> cuts = bisection.take_cuts();
  for (double &t : cuts)
    if (std::abs(t - std::round(t)) < at_point)
      t = std::round(t);
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  return cuts;
}

std::vector<double> own_points(const Curve &curve) {
  std::vector<double> t(curve.n_segments() + 1);
  std::iota(t.begin(), t.end(), 0.);
  return t;
}

std::vector<double> fewest_points(const Curve &curve, double hausdorff) {
  if (curve.is_frozen)
    return own_points(curve);
  const std::size_t n = curve.n_segments(), fewest = curve.is_loop ? 3 : 1;
  std::vector<double> cuts{0};
  for (std::size_t k = 0; k < fewest; ++k)
    halve_chord(curve, n * k / fewest, n * (k + 1) / fewest, hausdorff, cuts);
  return cuts;
}

} // namespace anistar
