#include "surface/surface_features.h"

#include "mesh/disjoint_sets.h"
#include "search/box_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace anistar {
namespace {

/// Points this close to a plane or line, relative to the extent of the patch or curve,
/// are on it.
constexpr double flat_tolerance = 1e-10;

struct Side { ///< an edge as one facet has it
  Index low, high;
  std::size_t facet;
  bool is_forward; ///< the facet runs from low to high
};

struct Ridge {
  std::array<Index, 2> ends;
  Index tag;
  bool is_given;
  std::vector<Index> patches; ///< of the facets at it, in order
};

class Classifier {
public:
  Classifier(const SurfaceInput &input, const RidgeChoice &choose)
      : in_(input), choose_(choose) {}

  Features run() {
    collect_sides();
    find_given();
    find_ridges();
    choose_sharp_folds();
    make_patches();
    classify_points();
    make_curves();
    return std::move(out_);
  }

private:
  const SurfaceInput &in_;
  const RidgeChoice &choose_;
  Features out_;
  std::vector<Side> sides_;
  std::vector<std::pair<std::array<Index, 2>, Index>> given_;
  std::vector<Ridge> ridges_;
  std::vector<Fold> folds_; ///< and ridges, until the sharp ones are chosen
  std::vector<std::vector<std::size_t>> at_point_; ///< ridges at a point

  [[nodiscard]] const Vector<3> &point(Index v) const { return in_.points[v]; }
  [[nodiscard]] Vector<3> normal(std::size_t f) const {
    const Facet<3> &t = in_.facets[f];
    return (point(t[1]) - point(t[0])).cross(point(t[2]) - point(t[0]));
  }

  void collect_sides() {
    for (std::size_t f = 0; f < in_.facets.size(); ++f)
      for (std::size_t i = 0; i < 3; ++i) {
        const Index u = in_.facets[f][i], w = in_.facets[f][(i + 1) % 3];
        sides_.push_back({std::min(u, w), std::max(u, w), f, u < w});
      }
    std::sort(sides_.begin(), sides_.end(), [](const Side &a, const Side &b) {
      return std::tie(a.low, a.high, a.facet) < std::tie(b.low, b.high, b.facet);
    });
  }

  void find_given() {
    for (std::size_t e = 0; e < in_.edges.size(); ++e)
      given_.push_back({{std::min(in_.edges[e][0], in_.edges[e][1]),
                         std::max(in_.edges[e][0], in_.edges[e][1])},
                        in_.edge_tags[e]});
    std::stable_sort(given_.begin(), given_.end(),
                     [](const auto &a, const auto &b) { return a.first < b.first; });
  }

  /// Whether the surface goes through an edge, as far as angles do not matter.
  [[nodiscard]] bool is_fold(std::span<const Side> group) const {
    return group.size() == 2 &&
           in_.facet_tags[group[0].facet] == in_.facet_tags[group[1].facet];
  }
  [[nodiscard]] Fold fold_of(std::span<const Side> group) const {
    const Vector<3> m = normal(group[0].facet), n = normal(group[1].facet);
    const double sign = group[0].is_forward == group[1].is_forward ? -1 : 1;
    return {{group[0].low, group[0].high},
            {group[0].facet, group[1].facet},
            turn_between(m, sign * n)};
  }
  /// In degrees.
  static double turn_between(const Vector<3> &u, const Vector<3> &v) {
    return elementary::angle_of(u.cross(v).norm(), u.dot(v)) * (180 / std::numbers::pi);
  }

  void find_ridges() {
    std::size_t next_given = 0;
    const auto take_given = [&](std::array<Index, 2> ends, Index &tag) {
      // given edges without a facet lie inside the domain
      while (next_given < given_.size() && given_[next_given].first < ends) {
        ridges_.push_back(
            {given_[next_given].first, given_[next_given].second, true, {}});
        ++next_given;
      }
      bool found = false;
      while (next_given < given_.size() && given_[next_given].first == ends) {
        tag = given_[next_given++].second;
        found = true;
      }
      return found;
    };
    for (std::size_t begin = 0, end = 0; begin < sides_.size(); begin = end) {
      while (end < sides_.size() && sides_[end].low == sides_[begin].low &&
             sides_[end].high == sides_[begin].high)
        ++end;
      const std::span group(sides_.data() + begin, end - begin);
      const std::array<Index, 2> ends{group[0].low, group[0].high};
      Index tag = 0;
      const bool is_given = take_given(ends, tag);
      if (!is_given && is_fold(group)) {
        folds_.push_back(fold_of(group));
        continue;
      }
      Ridge ridge{ends, tag, is_given, {}};
      for (const Side &side : group)
        ridge.patches.push_back(static_cast<Index>(side.facet));
      ridges_.push_back(std::move(ridge));
    }
    Index unused = 0;
    take_given({std::numeric_limits<Index>::max(), 0}, unused);
  }

  /// The other folds join their facets to patches, and to the sides of ridges.
  void choose_sharp_folds() {
    std::vector<std::array<Index, 2>> others;
    for (const Ridge &ridge : ridges_)
      others.push_back(ridge.ends);
    std::vector<bool> is_sharp = sharp_folds(in_, folds_, others);
    if (choose_)
      is_sharp = choose_(folds_, others, std::move(is_sharp));
    DisjointSets patches(in_.facets.size()), sides(3 * in_.facets.size());
    for (std::size_t k = 0; k < folds_.size(); ++k) {
      const auto [ends, facets, turn] = folds_[k];
      if (is_sharp[k]) {
        ridges_.push_back({ends, 0, false, {}});
        for (std::size_t f : facets)
          ridges_.back().patches.push_back(static_cast<Index>(f));
        continue;
      }
      patches.join(facets[0], facets[1]);
      for (Index v : ends)
        sides.join(corner_of(facets[0], v), corner_of(facets[1], v));
    }
    std::sort(ridges_.begin(), ridges_.end(),
              [](const Ridge &a, const Ridge &b) { return a.ends < b.ends; });
    std::size_t n_patches = 0;
    out_.facet_patch = patches.numbers(n_patches);
    out_.patches.resize(n_patches);
    out_.facet_sides.resize(in_.facets.size());
    const std::vector<Index> side = sides.numbers(out_.n_sides);
    for (std::size_t f = 0; f < in_.facets.size(); ++f)
      for (std::size_t i = 0; i < 3; ++i)
        out_.facet_sides[f][i] = side[3 * f + i];
  }
  [[nodiscard]] std::size_t corner_of(std::size_t f, Index v) const {
    const Facet<3> &t = in_.facets[f];
    return 3 * f + (t[0] == v ? 0 : t[1] == v ? 1 : 2);
  }

  void make_patches() {
    const std::size_t n = out_.patches.size();
    std::vector<double> largest(n, -1);
    std::vector<Box<3>> box(n);
    const auto patch_of = [&](std::size_t f) {
      return static_cast<std::size_t>(out_.facet_patch[f]);
    };
    for (std::size_t f = 0; f < in_.facets.size(); ++f) {
      Patch &patch = out_.patches[patch_of(f)];
      patch.tag = in_.facet_tags[f];
      patch.is_frozen = in_.shape.is_frozen(patch.tag);
      const Vector<3> m = normal(f);
      if (m.squaredNorm() > largest[patch_of(f)]) {
        largest[patch_of(f)] = m.squaredNorm();
        patch.normal = m;
        patch.origin = point(in_.facets[f][0]);
      }
      for (Index v : in_.facets[f])
        box[patch_of(f)].extend(point(v));
    }
    if (in_.shape.is_faceted())
      take_mean_planes();
    for (Patch &patch : out_.patches) {
      patch.normal = snapped(patch.normal);
      patch.is_planar = true;
    }
    for (std::size_t f = 0; f < in_.facets.size(); ++f) {
      Patch &patch = out_.patches[patch_of(f)];
      if (in_.shape.is_faceted())
        break;
      const double extent = (box[patch_of(f)].high - box[patch_of(f)].low).maxCoeff();
      for (Index v : in_.facets[f])
        patch.is_planar =
            patch.is_planar && std::abs(patch.normal.dot(point(v) - patch.origin)) <=
                                   flat_tolerance * extent;
    }
    for (Ridge &ridge : ridges_) {
      for (Index &patch : ridge.patches)
        patch = out_.facet_patch[patch];
      std::sort(ridge.patches.begin(), ridge.patches.end());
    }
  }

  /// Of patches that are not quite planar: the plane through the middle of their area,
  /// on which their points leave the volume as it is but for second order.
  void take_mean_planes() {
    const std::size_t n = out_.patches.size();
    std::vector<Vector<3>> normals(n, Vector<3>::Zero()), middles(n, Vector<3>::Zero());
    std::vector<double> areas(n, 0);
    for (std::size_t f = 0; f < in_.facets.size(); ++f) {
      const auto p = static_cast<std::size_t>(out_.facet_patch[f]);
      const auto &[a, b, c] = in_.facets[f];
      const Vector<3> m = normal(f);
      normals[p] += m.dot(out_.patches[p].normal) < 0 ? -m : m;
      // from a corner, so that a shift of the whole costs no digits
      const Vector<3> &from = out_.patches[p].origin;
      middles[p] +=
          m.norm() * ((point(a) - from) + (point(b) - from) + (point(c) - from)) / 3;
      areas[p] += m.norm();
    }
    for (std::size_t p = 0; p < n; ++p)
      if (areas[p] > 0) {
        out_.patches[p].normal = normals[p];
        out_.patches[p].origin += middles[p] / areas[p];
      }
  }

  /// A unit vector; one along an axis but for round-off is made so.
  static Vector<3> snapped(const Vector<3> &given) {
    Vector<3> unit = given / std::max(given.norm(), 1e-300);
    for (int k = 0; k < 3; ++k)
      if (std::abs(unit[k]) < 1e-13)
        unit[k] = 0;
    return unit / std::max(unit.norm(), 1e-300);
  }

  void classify_points() {
    const std::size_t n = in_.points.size();
    out_.dimension.assign(n, 3);
    out_.support.assign(n, none);
    at_point_.resize(n);
    for (std::size_t r = 0; r < ridges_.size(); ++r)
      for (Index v : ridges_[r].ends)
        at_point_[v].push_back(r);
    classify_surface_points();
    for (std::size_t v = 0; v < n; ++v)
      if (!at_point_[v].empty())
        out_.dimension[v] =
            out_.dimension[v] != 0 && is_smooth_ridge_point(static_cast<Index>(v)) ? 1
                                                                                   : 0;
    for (Index v : in_.corners)
      out_.dimension[v] = 0;
    for (std::size_t f = 0; f < in_.facets.size(); ++f)
      if (out_.patches[out_.facet_patch[f]].is_frozen)
        for (Index v : in_.facets[f])
          out_.dimension[v] = 0;
  }

  /// A point where sheets only touch is a corner.
  void classify_surface_points() {
    std::vector<std::vector<std::size_t>> facets(in_.points.size());
    for (std::size_t f = 0; f < in_.facets.size(); ++f)
      for (Index v : in_.facets[f])
        facets[v].push_back(f);
    for (std::size_t v = 0; v < facets.size(); ++v) {
      if (facets[v].empty())
        continue;
      out_.dimension[v] = is_one_fan(facets[v]) ? 2 : 0;
      out_.support[v] = out_.facet_patch[facets[v].front()];
    }
  }

  /// Whether the facets at a point are joined by edges.
  [[nodiscard]] bool is_one_fan(const std::vector<std::size_t> &fan) const {
    DisjointSets sets(fan.size());
    const auto shares_edge = [&](std::size_t f, std::size_t g) {
      int common = 0;
      for (Index a : in_.facets[f])
        for (Index b : in_.facets[g])
          common += a == b;
      return common >= 2;
    };
    for (std::size_t i = 0; i < fan.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (shares_edge(fan[i], fan[j]))
          sets.join(i, j);
    std::size_t n = 0;
    (void)sets.numbers(n);
    return n == 1;
  }

  [[nodiscard]] bool is_smooth_ridge_point(Index v) const {
    const auto &here = at_point_[v];
    if (here.size() != 2)
      return false;
    const Ridge &r = ridges_[here[0]], &s = ridges_[here[1]];
    if (r.tag != s.tag || r.is_given != s.is_given || r.patches != s.patches)
      return false;
    if (r.patches.empty() && out_.dimension[v] != 3)
      return false; // a line inside the domain goes through a surface
    const auto leg = [&](const Ridge &ridge) -> Vector<3> {
      return point(ridge.ends[ridge.ends[0] == v ? 1 : 0]) - point(v);
    };
    return turn_between(-leg(r), leg(s)) < in_.shape.sharp_turn();
  }

  void make_curves() {
    DisjointSets sets(ridges_.size());
    for (std::size_t v = 0; v < at_point_.size(); ++v)
      if (out_.dimension[v] == 1)
        sets.join(at_point_[v][0], at_point_[v][1]);
    std::size_t n = 0;
    const std::vector<Index> curve_of = sets.numbers(n);
    out_.curves.resize(n);
    std::vector<std::vector<Index>> points(n);
    for (std::size_t r = 0; r < ridges_.size(); ++r) {
      const std::size_t c = curve_of[r];
      out_.curves[c].tag = ridges_[r].tag;
      out_.curves[c].is_given = ridges_[r].is_given;
      out_.ridges.push_back({ridges_[r].ends, curve_of[r]});
      for (Index v : ridges_[r].ends) {
        points[c].push_back(v);
        if (out_.dimension[v] == 1)
          out_.support[v] = curve_of[r];
      }
    }
    for (std::size_t c = 0; c < n; ++c)
      fit_line(out_.curves[c], points[c]);
  }

  void fit_line(SurfaceCurve &curve, const std::vector<Index> &points) const {
    curve.origin = point(points.front());
    Vector<3> far = curve.origin;
    for (Index v : points) // the farthest point from the first, then from that one
      if ((point(v) - curve.origin).squaredNorm() > (far - curve.origin).squaredNorm())
        far = point(v);
    const Vector<3> first = far;
    for (Index v : points)
      if ((point(v) - first).squaredNorm() > (curve.origin - first).squaredNorm())
        curve.origin = point(v);
    const double extent = (first - curve.origin).norm();
    curve.direction = snapped(first - curve.origin);
    curve.is_straight = true;
    for (Index v : points) {
      const Vector<3> u = point(v) - curve.origin;
      curve.is_straight =
          curve.is_straight && (u - curve.direction * curve.direction.dot(u)).norm() <=
                                   flat_tolerance * extent;
    }
  }
};

} // namespace

Features find_features(const SurfaceInput &input, const RidgeChoice &choose) {
  return Classifier(input, choose).run();
}

} // namespace anistar
