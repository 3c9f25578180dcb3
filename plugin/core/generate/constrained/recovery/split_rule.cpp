#include "generate/constrained/recovery/split_rule.h"

#include "base/errors.h"
#include "generate/constrained/mesh/edge_crossing.h"

#include <algorithm>
#include <string>

namespace anistar::generate {
namespace {

/// The cosine of 60 degrees: lines that meet below it make their vertex acute.
constexpr double acute_cosine = .5;
/// So many directions at most are in pairs 60 degrees apart (the kissing number).
constexpr std::size_t most_directions = 12;
/// How near a part may be divided to its ends.
constexpr double least_part = .02;

bool are_acute(const std::vector<Vector<3>> &directions) {
  if (directions.size() > most_directions)
    return true;
  for (std::size_t i = 0; i < directions.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double lengths = directions[i].norm() * directions[j].norm();
      if (directions[i].dot(directions[j]) > acute_cosine * lengths)
        return true;
    }
  return false;
}

} // namespace

SplitRule::SplitRule(const ExactPoints &points, const GhostMesh &mesh,
                     const FacetTriangles &facets)
    : points_(points), mesh_(mesh), facets_(facets),
      is_acute_(points.n_given(), false) {
  // lines within facets make no vertex acute: they may be chosen otherwise
  PerVertex<std::vector<Vector<3>>> directions(points.n_given());
  for (const Line &line : facets.lines())
    if (!line.is_flat()) {
      const Vector<3> along = points.rounded(line.to) - points.rounded(line.from);
      directions[line.from].push_back(along);
      directions[line.to].push_back(-along);
    }
  for (std::size_t v = 0; v < directions.size(); ++v)
    is_acute_[v] = are_acute(directions[v]);
}

bool SplitRule::is_acute(Index v) const {
  return v < points_.n_given() && is_acute_[v];
}

LinePart SplitRule::part_of(Index edge) const {
  const FacetTriangles::Edge &e = facets_.edges()[edge];
  const Line &line = facets_.lines()[e.line];
  const auto fraction_of = [&](Index v) {
    return v == line.from ? 0. : v == line.to ? 1. : points_.steiner(v).t;
  };
  LinePart part{e.line, e.from, e.to, fraction_of(e.from), fraction_of(e.to)};
  if (part.low > part.high) {
    std::swap(part.from, part.to);
    std::swap(part.low, part.high);
  }
  return part;
}

/// The vertex in the way that sees the part under the largest angle, from within its
/// diametral sphere.
Index SplitRule::reference_point(const LinePart &part) const {
  Index best = none;
  double least_cosine = 0;
  for (const Index v : vertices_between(points_, mesh_, part.from, part.to)) {
    const Vector<3> one = points_.rounded(part.from) - points_.rounded(v),
                    other = points_.rounded(part.to) - points_.rounded(v);
    const double cosine = one.dot(other) / (one.norm() * other.norm());
    if (cosine < least_cosine) {
      least_cosine = cosine;
      best = v;
    }
  }
  return best;
}

void SplitRule::refuse_point_between(const LinePart &part, Index v) const {
  const Line &line = facets_.lines()[part.line];
  if (points_.are_collinear(part.from, part.to, v))
    throw MeshingError("point " + std::to_string(v) + " lies on the edge from point " +
                           std::to_string(line.from) + " to point " +
                           std::to_string(line.to) + ", which does not end there",
                       points_.rounded(v));
}

/// Whether a point was put on a line from this end, where lines meet at acute angles.
bool SplitRule::share_acute_end(Index end, Index reference) const {
  if (!is_acute(end) || reference < points_.n_given())
    return false;
  const SteinerPoint &point = points_.steiner(reference);
  return point.a == end || point.b == end;
}

double SplitRule::foot_of(const LinePart &part, Index reference) const {
  const Line &line = facets_.lines()[part.line];
  const Vector<3> &start = points_.rounded(line.from);
  const Vector<3> along = points_.rounded(line.to) - start;
  return along.dot(points_.rounded(reference) - start) / along.squaredNorm();
}

/// On the sphere about an acute end of the line through the reference point, so that
/// the parts of lines that meet there become equally long.
double SplitRule::round_acute_end(const LinePart &part, Index reference,
                                  bool at_from) const {
  const Line &line = facets_.lines()[part.line];
  const double length = std::sqrt(points_.squared_distance(line.from, line.to));
  const Index end = at_from ? line.from : line.to;
  const double radius = std::sqrt(points_.squared_distance(end, reference)) / length;
  const double at = at_from ? radius : 1 - radius;
  if (!(at > part.low && at < part.high))
    return .5 * (part.low + part.high);
  const Vector<3> place =
      (1 - at) * points_.rounded(line.from) + at * points_.rounded(line.to);
  const double gap = (place - points_.rounded(reference)).norm() / length;
  const double near = at_from ? at - part.low : part.high - at;
  const double far = part.high - part.low - near;
  if (far >= gap)
    return at;
  const double back = gap < .5 * near ? gap : .5 * near;
  return at_from ? at - back : at + back;
}

double SplitRule::fraction(const LinePart &part) const {
  const double middle = .5 * (part.low + part.high);
  const Index reference = reference_point(part);
  if (reference == none)
    return middle;
  refuse_point_between(part, reference);
  const Line &line = facets_.lines()[part.line];
  const bool from = share_acute_end(line.from, reference),
             to = share_acute_end(line.to, reference);
  if (from && to && part.from == line.from && part.to == line.to)
    return middle;
  const double at =
      !from && !to ? foot_of(part, reference)
                   : round_acute_end(part, reference, from && (!to || middle <= .5));
  const double margin = least_part * (part.high - part.low);
  return std::clamp(at, part.low + margin, part.high - margin);
}

} // namespace anistar::generate
