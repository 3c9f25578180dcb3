#include "plane/geometry/outline.h"

#include "base/errors.h"
#include "plane/geometry/cuts.h"
#include "search/box_tree.h"

#include <algorithm>
#include <cmath>

namespace anistar {
namespace {

/// More edges than this on one curve are an absurd request.
constexpr double most_edges = 1e9;
/// A frozen curve is not divided: only the angles at its corners ask for its length.
constexpr double most_frozen = 1e5;

/// @throws BudgetSpent, MeshingError as make_outline does
std::vector<LengthTable> tabulate_lengths(const Geometry &geometry,
                                          const Background<2> &background,
                                          std::size_t n_vertices, Monitor &monitor) {
  std::vector<LengthTable> tables;
  for (const Curve &curve : geometry.curves) {
    const double most = curve.is_frozen ? most_frozen : most_edges;
    tables.push_back(tabulate_length(curve, background, most, n_vertices, monitor));
    const double total = tables.back().total();
    if (!curve.is_frozen && !(total < most))
      throw MeshingError("the metric asks for more than a billion edges on the curve "
                         "with tag " +
                             std::to_string(curve.tag) + ", which begins",
                         curve.at(0));
    n_vertices +=
        curve.is_frozen ? curve.n_segments() : static_cast<std::size_t>(total);
    monitor.insist(n_vertices);
  }
  return tables;
}

/// Adds curves, cut at given parameters, to an outline.
class OutlineMaker {
public:
  OutlineMaker(const Geometry &geometry, const Background<2> &background)
      : geometry_(geometry), background_(background),
        vertex_of_(geometry.points.size(), none) {
    for (std::size_t v = 0; v < geometry.points.size(); ++v)
      if (geometry.is_corner[v])
        (void)fixed(static_cast<Index>(v));
    for (const auto &[point, region] : geometry.free_points)
      outline_.free_points.push_back({fixed(point), region});
  }

  [[nodiscard]] std::size_t n_vertices() const { return outline_.vertices.size(); }
  [[nodiscard]] Outline take() { return std::move(outline_); }

  void add(std::size_t c, const std::vector<double> &t, const Shells &shells) {
    const Curve &curve = geometry_.curves[c];
    // the seam of a loop stays: a parameter must begin somewhere
    Index previous = fixed(curve.vertices.front());
    for (std::size_t k = 1; k < t.size(); ++k) {
      const bool is_last = k + 1 == t.size();
      const Index next =
          is_last ? fixed(curve.vertices.back())
                  : add(curve.at(t[k]), curve.is_frozen ? Triangulation<2>::corner : 1);
      const Index ball = k == 1 && shells.first   ? shells.first->ball
                         : is_last && shells.last ? shells.last->ball
                                                  : none;
      outline_.edges.push_back(
          {static_cast<Index>(c), t[k - 1], t[k], previous, next, ball});
      previous = next;
    }
  }

private:
  const Geometry &geometry_;
  const Background<2> &background_;
  std::vector<Index> vertex_of_;
  Outline outline_;

  Index add(const Vector<2> &x, Index feature) {
    Index cell = outline_.background.empty() ? none : outline_.background.back();
    outline_.vertices.push_back(background_.vertex(x, cell));
    outline_.background.push_back(cell);
    outline_.feature.push_back(feature);
    return static_cast<Index>(outline_.vertices.size()) - 1;
  }
  Index fixed(Index v) {
    Index &known = vertex_of_[v];
    if (known == none)
      known = add(geometry_.points[v], Triangulation<2>::corner);
    return known;
  }
};

bool between(const Vector<2> &a, const Vector<2> &b, const Vector<2> &p) {
  return std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) &&
         std::min(a[1], b[1]) <= p[1] && p[1] <= std::max(a[1], b[1]);
}

/// Whether p lies on the closed segment ab.
bool is_on(const Vector<2> &a, const Vector<2> &b, const Vector<2> &p) {
  return between(a, b, p) && orientation(a, b, p) == Orientation::degenerate;
}

bool segments_meet(const Vector<2> &a, const Vector<2> &b, const Vector<2> &p,
                   const Vector<2> &q) {
  const Orientation abp = orientation(a, b, p), abq = orientation(a, b, q);
  const Orientation pqa = orientation(p, q, a), pqb = orientation(p, q, b);
  if (abp != abq && pqa != pqb && abp != Orientation::degenerate &&
      abq != Orientation::degenerate && pqa != Orientation::degenerate &&
      pqb != Orientation::degenerate)
    return true;
  return is_on(a, b, p) || is_on(a, b, q) || is_on(p, q, a) || is_on(p, q, b);
}

} // namespace

Outline make_outline(const Geometry &geometry, const Background<2> &background,
                     const Run &run) {
  OutlineMaker maker(geometry, background);
  const std::vector<LengthTable> lengths =
      tabulate_lengths(geometry, background, maker.n_vertices(), run.monitor);
  const Protection protection = protect_corners(geometry, background, lengths, run);
  for (std::size_t c = 0; c < geometry.curves.size(); ++c) {
    const Shells &shells = protection.shells[c];
    maker.add(c, unit_cuts(geometry.curves[c], lengths[c], shells, run), shells);
    run.monitor.insist(maker.n_vertices());
  }
  Outline outline = maker.take();
  outline.n_balls = protection.n_balls;
  outline.n_unprotected = protection.given_up;
  return outline;
}

Outline outline_at_points(const Geometry &geometry, const Background<2> &background,
                          const Run &run) {
  OutlineMaker maker(geometry, background);
  std::size_t n_vertices = maker.n_vertices();
  for (const Curve &curve : geometry.curves)
    n_vertices += curve.n_segments();
  const bool has_room = run.monitor.has_room(n_vertices);
  for (std::size_t c = 0; c < geometry.curves.size(); ++c) {
    const Curve &curve = geometry.curves[c];
    maker.add(c,
              has_room ? own_points(curve) : fewest_points(curve, run.hausdorff.curve),
              {});
  }
  return maker.take();
}

bool retreat(Geometry &geometry, const Background<2> &background, Outline &outline,
             const std::vector<Index> &edges, const std::function<void()> &look) {
  bool changed = false;
  const auto move = [&](Index v, const Vector<2> &x) {
    changed = changed || outline.vertices[v].x != x;
    outline.vertices[v] = background.vertex(x, outline.background[v]);
  };
  const auto give_up = [&](Index ball) {
    for (CurveEdge &edge : outline.edges)
      if (edge.ball == ball)
        edge.ball = none;
  };
  for (Index e : edges) {
    look();
    const CurveEdge edge = outline.edges[e];
    Curve &curve = geometry.curves[edge.curve];
    const double first = std::floor(edge.t0) + 1, last = std::ceil(edge.t1) - 1;
    if (first <= last) {
      const double t = std::floor(.5 * (first + last));
      Index cell = outline.background[edge.v0];
      outline.vertices.push_back(background.vertex(curve.at(t), cell));
      outline.background.push_back(cell);
      outline.feature.push_back(1);
      const auto v = static_cast<Index>(outline.vertices.size()) - 1;
      outline.edges[e] = edge.before(t, v);
      outline.edges.push_back(edge.after(t, v));
      give_up(edge.ball);
      changed = true;
    } else {
      const double segment = std::floor(edge.t0);
      curve.straighten(static_cast<std::size_t>(segment));
      for (const CurveEdge &other : outline.edges)
        if (other.curve == edge.curve)
          for (const auto &[v, t] :
               {std::pair(other.v0, other.t0), {other.v1, other.t1}})
            if (segment < t && t < segment + 1) {
              move(v, curve.at(t));
              give_up(other.ball);
            }
    }
  }
  return changed;
}

std::size_t count_balls(std::span<const CurveEdge> edges) {
  std::vector<Index> balls;
  for (const CurveEdge &edge : edges)
    if (edge.ball != none)
      balls.push_back(edge.ball);
  std::sort(balls.begin(), balls.end());
  return static_cast<std::size_t>(std::unique(balls.begin(), balls.end()) -
                                  balls.begin());
}

std::vector<Index> edges_before(const Geometry &geometry, const Outline &outline,
                                const Vector<2> &x) {
  std::vector<Index> found;
  std::vector<Vector<2>> lens;
  for (std::size_t e = 0; e < outline.edges.size(); ++e) {
    const CurveEdge &edge = outline.edges[e];
    const Curve &curve = geometry.curves[edge.curve];
    lens = {outline.vertices[edge.v1].x, outline.vertices[edge.v0].x,
            curve.on_polyline(edge.t0)};
    for (double t = std::floor(edge.t0) + 1; t < edge.t1; ++t)
      lens.push_back(curve.on_polyline(t));
    lens.push_back(curve.on_polyline(edge.t1));
    bool is_inside = false; // by the parity of a ray's crossings
    for (std::size_t k = 0; k < lens.size(); ++k) {
      const Vector<2> &a = lens[k], &b = lens[(k + 1) % lens.size()];
      if ((a[1] > x[1]) != (b[1] > x[1]) &&
          x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
        is_inside = !is_inside;
    }
    if (is_inside)
      found.push_back(static_cast<Index>(e));
  }
  return found;
}

std::vector<Index> conflicts(const Outline &outline,
                             const std::function<void()> &look) {
  std::vector<Box<2>> boxes(outline.edges.size());
  const auto x = [&](Index v) -> const Vector<2> & { return outline.vertices[v].x; };
  for (std::size_t e = 0; e < boxes.size(); ++e) {
    boxes[e].extend(x(outline.edges[e].v0));
    boxes[e].extend(x(outline.edges[e].v1));
  }
  const BoxTree<2> tree(boxes);
  std::vector<Index> found;
  for (std::size_t e = 0; e < boxes.size(); ++e) {
    look();
    const CurveEdge &one = outline.edges[e];
    bool clashes = x(one.v0) == x(one.v1);
    tree.meeting(boxes[e], [&](Index item) {
      const CurveEdge &two = outline.edges[item];
      if (std::cmp_equal(item, e))
        return true;
      const bool common0 = one.v0 == two.v0 || one.v0 == two.v1;
      const bool common1 = one.v1 == two.v0 || one.v1 == two.v1;
      if (common0 && common1) {
        clashes = true;
      } else if (common0 || common1) {
        const Index mine = common0 ? one.v1 : one.v0;
        const Index shared = common0 ? one.v0 : one.v1;
        const Index other = two.v0 == shared ? two.v1 : two.v0;
        clashes = clashes || is_on(x(two.v0), x(two.v1), x(mine)) ||
                  is_on(x(one.v0), x(one.v1), x(other));
      } else {
        clashes = clashes || segments_meet(x(one.v0), x(one.v1), x(two.v0), x(two.v1));
      }
      return !clashes;
    });
    for (const FreePoint &free : outline.free_points)
      clashes = clashes || is_on(x(one.v0), x(one.v1), x(free.point));
    if (clashes)
      found.push_back(static_cast<Index>(e));
  }
  return found;
}

} // namespace anistar
