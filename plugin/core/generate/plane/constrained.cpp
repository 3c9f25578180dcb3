#include "generate/plane/constrained.h"

#include "base/errors.h"
#include "base/range.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>

namespace anistar::generate {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using FaceBase = CGAL::Triangulation_face_base_with_info_2<
    Index, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_tag>;
using Vertex = Cdt::Vertex_handle;
using Face = Cdt::Face_handle;

/// Finds the number of a segment by its ends.
class SegmentTable {
public:
  explicit SegmentTable(std::span<const Segment> segments) : segments_(segments) {
    order_.resize(segments.size());
    std::iota(order_.begin(), order_.end(), Index{0});
    std::sort(order_.begin(), order_.end(), [this](Index s, Index t) {
      return std::pair(key(s), s) < std::pair(key(t), t);
    });
  }
  [[nodiscard]] Index find(Index a, Index b) const {
    const Segment wanted{std::min(a, b), std::max(a, b)};
    const auto found =
        std::lower_bound(order_.begin(), order_.end(), wanted,
                         [this](Index s, const Segment &w) { return key(s) < w; });
    return found != order_.end() && key(*found) == wanted ? *found : none;
  }

private:
  std::span<const Segment> segments_;
  std::vector<Index> order_;

  [[nodiscard]] Segment key(Index s) const {
    const auto [a, b] = segments_[s];
    return {std::min(a, b), std::max(a, b)};
  }
};

std::vector<Index> used_points(const PlanarComplex &complex) {
  std::vector<Index> used(complex.points_kept.begin(), complex.points_kept.end());
  for (const Segment &segment : complex.segments)
    used.insert(used.end(), segment.begin(), segment.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return used;
}

std::vector<Kernel::Point_2> places_of(const PlanarComplex &complex) {
  std::vector<Kernel::Point_2> places;
  for (const Vector<2> &x : complex.points) {
    require_finite(x);
    places.emplace_back(x[0], x[1]);
  }
  return places;
}

/// The vertex of every point that is used, inserted in the order of a curve that fills
/// the plane.
std::vector<Vertex> insert_points(Cdt &cdt, const PlanarComplex &complex,
                                  Monitor &monitor) {
  const std::vector<Kernel::Point_2> places = places_of(complex);
  const std::vector<Index> used = used_points(complex);
  std::vector<std::size_t> order(used.begin(), used.end());
  using Places = CGAL::Pointer_property_map<Kernel::Point_2>::const_type;
  CGAL::spatial_sort(order.begin(), order.end(),
                     CGAL::Spatial_sort_traits_adapter_2<Kernel, Places>(
                         CGAL::make_property_map(places)));
  std::vector<Vertex> vertices(places.size());
  Face hint;
  for (const std::size_t place : order) {
    const auto k = static_cast<Index>(place);
    monitor.insist(cdt.number_of_vertices());
    const std::size_t before = cdt.number_of_vertices();
    const Vertex v = cdt.insert(places[k], hint);
    if (cdt.number_of_vertices() == before)
      throw MeshingError("points " + std::to_string(std::min(v->info(), k)) + " and " +
                             std::to_string(std::max(v->info(), k)) + " coincide",
                         complex.points[k]);
    v->info() = k;
    vertices[k] = v;
    hint = v->face();
  }
  return vertices;
}

/// What is in the way of a segment: a point on it, or another segment across it.
struct Obstacle {
  Index point;
  Index segment;
};

/// Follows a segment from one end to the other.
class Trace {
public:
  Trace(const Cdt &cdt, const SegmentTable &table, Vertex a, Vertex b)
      : cdt_(cdt), table_(table), a_(a), b_(b) {}

  [[nodiscard]] std::optional<Obstacle> obstacle() const {
    Cdt::Face_circulator f = cdt_.incident_faces(a_), end = f;
    do {
      if (cdt_.is_infinite(f))
        continue;
      const int i = f->index(a_);
      const Vertex u = f->vertex(Cdt::ccw(i)), v = f->vertex(Cdt::cw(i));
      if (u == b_ || v == b_)
        return {};
      for (const Vertex w : {u, v})
        if (side(w) == CGAL::COLLINEAR && is_ahead(w))
          return Obstacle{w->info(), none};
      if (side(u) == CGAL::RIGHT_TURN && side(v) == CGAL::LEFT_TURN)
        return beyond(f, i);
    } while (++f != end);
    return {};
  }

private:
  const Cdt &cdt_;
  const SegmentTable &table_;
  Vertex a_, b_;

  [[nodiscard]] CGAL::Orientation side(Vertex w) const {
    return CGAL::orientation(a_->point(), b_->point(), w->point());
  }
  /// @pre w is on the line
  [[nodiscard]] bool is_ahead(Vertex w) const {
    return !CGAL::collinear_are_strictly_ordered_along_line(w->point(), a_->point(),
                                                            b_->point());
  }
  /// From the edge of f that is opposite i on.
  [[nodiscard]] std::optional<Obstacle> beyond(Face f, int i) const {
    for (;;) { // ends at b: every step is nearer to it, in a finite triangulation
      if (f->is_constrained(i))
        return Obstacle{none, table_.find(f->vertex(Cdt::ccw(i))->info(),
                                          f->vertex(Cdt::cw(i))->info())};
      const Vertex right = f->vertex(Cdt::ccw(i));
      const Face next = f->neighbor(i);
      const int entry = next->index(f);
      const Vertex w = next->vertex(entry);
      if (w == b_)
        return {};
      const CGAL::Orientation on = side(w);
      if (on == CGAL::COLLINEAR)
        return Obstacle{w->info(), none};
      // leaves between w and the one on the other side, opposite the one on its own
      const int of_right = next->index(right), of_left = 3 - entry - of_right;
      i = on == CGAL::RIGHT_TURN ? of_right : of_left;
      f = next;
    }
  }
};

/// Where two segments cross, rounded.
Vector<2> crossing(const PlanarComplex &complex, Index s, Index t) {
  const Vector<2> &a = complex.points[complex.segments[s][0]],
                  &b = complex.points[complex.segments[s][1]],
                  &c = complex.points[complex.segments[t][0]],
                  &d = complex.points[complex.segments[t][1]];
  const double across = cross(b - a, d - c);
  const double share = across == 0 ? .5 : cross(c - a, d - c) / across;
  return a + std::clamp(share, 0., 1.) * (b - a);
}

/// The segments that cannot all be edges.
class Conflicts {
public:
  explicit Conflicts(const PlanarComplex &complex) : complex_(complex) {}

  void add(Index segment, const Obstacle &found) {
    if (count_++ > 0)
      return;
    if (found.point != none) {
      message_ = "point " + std::to_string(found.point) + " lies on segment " +
                 name_of(segment);
      place_ = complex_.points[found.point];
    } else {
      message_ = "segments " + name_of(std::min(segment, found.segment)) + " and " +
                 name_of(std::max(segment, found.segment)) + " cross";
      place_ = crossing(complex_, segment, found.segment);
    }
  }
  void raise_any() const {
    if (count_ == 0)
      return;
    const std::string others =
        count_ == 1 ? "" : " (and " + std::to_string(count_ - 1) + " more)";
    throw MeshingError(message_ + others, place_);
  }

private:
  const PlanarComplex &complex_;
  std::size_t count_ = 0;
  std::string message_;
  Vector<2> place_ = Vector<2>::Zero();

  [[nodiscard]] std::string name_of(Index s) const {
    const auto [a, b] = complex_.segments[s];
    return std::string("(").append(std::to_string(a)).append(", ") + std::to_string(b) +
           ")";
  }
};

void insert_segments(Cdt &cdt, const std::vector<Vertex> &vertices,
                     const PlanarComplex &complex, const SegmentTable &table,
                     Monitor &monitor) {
  Conflicts conflicts(complex);
  for (std::size_t s = 0; s < complex.segments.size(); ++s) {
    monitor.insist(cdt.number_of_vertices());
    const auto [a, b] = complex.segments[s];
    if (const auto found = Trace(cdt, table, vertices[a], vertices[b]).obstacle())
      conflicts.add(static_cast<Index>(s), *found);
    else
      cdt.insert_constraint(vertices[a], vertices[b]);
  }
  conflicts.raise_any();
}

PlaneMesh as_mesh(const Cdt &cdt, const PlanarComplex &complex,
                  const SegmentTable &table) {
  PlaneMesh mesh;
  mesh.points.assign(complex.points.begin(), complex.points.end());
  std::vector<Face> faces;
  for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f) {
    f->info() = static_cast<Index>(faces.size());
    faces.push_back(f);
  }
  for (const Face f : faces) {
    Neighbours<2> around;
    std::array<Index, 3> walls{none, none, none};
    for (int i = 0; i < 3; ++i) {
      const Face next = f->neighbor(i);
      if (!cdt.is_infinite(next))
        around[i] = HalfFacet(next->info(), static_cast<std::size_t>(next->index(f)));
      if (f->is_constrained(i))
        walls[i] =
            table.find(f->vertex(Cdt::ccw(i))->info(), f->vertex(Cdt::cw(i))->info());
    }
    mesh.cells.push_back(
        {f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
    mesh.neighbours.push_back(around);
    mesh.walls.push_back(walls);
  }
  mesh.regions.assign(mesh.cells.size(), 0);
  return mesh;
}

} // namespace

PlaneMesh constrained_hull(const PlanarComplex &complex, Monitor &monitor) {
  const SegmentTable table(complex.segments);
  Cdt cdt;
  const std::vector<Vertex> vertices = insert_points(cdt, complex, monitor);
  if (cdt.dimension() < 2)
    throw MeshingError("the points lie on one line", complex.points.empty()
                                                         ? Vector<2>(Vector<2>::Zero())
                                                         : complex.points.front());
  insert_segments(cdt, vertices, complex, table, monitor);
  return as_mesh(cdt, complex, table);
}

} // namespace anistar::generate
