#include "generate/facets/facet_triangulation.h"

#include "base/predicates.h"
#include "generate/facets/facet_error.h"
#include "generate/facets/facet_plane.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/spatial_sort.h>

#include <algorithm>
#include <map>

namespace anistar::generate {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Where a triangle lies: enclosed by the outer loop, by holes, each an odd number of
/// times.
struct Enclosure {
  bool is_reached = false, in_outer = false, in_hole = false;

  [[nodiscard]] bool is_filled() const { return in_outer && !in_hole; }
};

using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using FaceBase = CGAL::Triangulation_face_base_with_info_2<
    Enclosure, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

/// Which loops an edge belongs to. An outer loop may go along an edge and back, as it
/// does to reach a hole without a loop of its own.
struct Border {
  std::size_t n_outer = 0, n_holes = 0;
  std::size_t hole = 0; ///< the last of them

  /// What encloses its other side.
  [[nodiscard]] Enclosure beyond(Enclosure side) const {
    side.in_outer ^= n_outer % 2 == 1;
    side.in_hole ^= n_holes % 2 == 1;
    return side;
  }
};

Segment sorted(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

} // namespace

class FacetTriangulation::Work {
public:
  explicit Work(std::span<const Vector<3>> points)
      : points_(points), handle_(points.size()) {}

  std::vector<Facet<3>> triangles(const FacetLoops &facets, std::size_t facet,
                                  const View &view, std::span<const Segment> edges) {
    facet_ = facet;
    view_ = view;
    cdt_.clear();
    borders_.clear();
    insert_points(facets.points(facet));
    if (cdt_.dimension() < 2)
      throw facet_error(facet_, "its points are on one line");
    for (std::size_t k = 0; k < facets.n_loops(facet); ++k)
      insert_loop(facets.loop(facet, k), k);
    for (const Segment &edge : edges)
      if (is_free(edge))
        insert_edge(edge);
    fill();
    for (std::size_t k = 1; k < facets.n_loops(facet); ++k)
      require_inside(facets.loop(facet, k));
    return filled();
  }

private:
  std::span<const Vector<3>> points_;
  PerVertex<Cdt::Vertex_handle> handle_; ///< of the points of the facet
  std::vector<Index> own_;               ///< those points, each once
  std::map<Segment, Border> borders_;
  Cdt cdt_;
  std::size_t facet_ = 0;
  View view_{Vector<3>::Zero()};

  [[nodiscard]] Vector<2> seen(Index v) const { return view_(points_[v]); }
  [[nodiscard]] Kernel::Point_2 place(Index v) const {
    const Vector<2> x = seen(v);
    return {x[0], x[1]};
  }

  /// In the order of a curve that fills the plane.
  void insert_points(FacetLoops::Loop indices) {
    own_.assign(indices.begin(), indices.end());
    std::sort(own_.begin(), own_.end());
    own_.erase(std::unique(own_.begin(), own_.end()), own_.end());
    std::vector<std::pair<Kernel::Point_2, Index>> sites;
    for (const Index v : own_)
      sites.emplace_back(place(v), v);
    using Sites = CGAL::First_of_pair_property_map<decltype(sites)::value_type>;
    CGAL::spatial_sort(sites.begin(), sites.end(),
                       CGAL::Spatial_sort_traits_adapter_2<Kernel, Sites>());
    Cdt::Face_handle near;
    for (const auto &[point, v] : sites) {
      const std::size_t before = cdt_.number_of_vertices();
      const Cdt::Vertex_handle made = cdt_.insert(point, near);
      if (cdt_.number_of_vertices() == before)
        throw facet_error(facet_, "its points ", made->info(), " and ", v,
                          " are at one place");
      made->info() = v;
      handle_[v] = made;
      near = made->face();
    }
  }

  void insert_loop(FacetLoops::Loop loop, std::size_t number) {
    if (loop.size() < 2)
      return;
    const std::size_t n_edges = loop.size() == 2 ? 1 : loop.size();
    for (std::size_t k = 0; k < n_edges; ++k) {
      const Segment edge = sorted(loop[k], loop[(k + 1) % loop.size()]);
      if (edge[0] == edge[1])
        throw facet_error(facet_, "loop ", number, " has point ", edge[0],
                          " twice in a row; it ends without its first point");
      insert_edge(edge);
      Border &border = borders_[edge];
      if (number == 0)
        ++border.n_outer;
      else if (loop.size() > 2) {
        ++border.n_holes;
        border.hole = number;
      }
    }
  }

  void insert_edge(const Segment &edge) {
    const Cdt::Vertex_handle a = handle_[edge[0]], b = handle_[edge[1]];
    try {
      cdt_.insert_constraint(a, b);
    } catch (const Cdt::Intersection_of_constraints_exception &) {
      throw crossing(edge);
    }
    if (!cdt_.is_edge(a, b))
      throw facet_error(facet_, "point ", point_on(edge), " lies on its edge ",
                        told(edge[0], edge[1]), ", which does not end there");
  }

  /// Whether an edge meets the loops at its ends only.
  [[nodiscard]] bool is_free(const Segment &edge) const {
    return point_on(edge) == none &&
           std::none_of(borders_.begin(), borders_.end(),
                        [&](const auto &entry) { return cross(edge, entry.first); });
  }

  [[nodiscard]] std::invalid_argument crossing(const Segment &edge) const {
    for (const auto &[other, border] : borders_)
      if (cross(edge, other))
        return facet_error(facet_, "its edges ", told(other[0], other[1]), " and ",
                           told(edge[0], edge[1]), " cross");
    return facet_error(facet_, "its edge ", told(edge[0], edge[1]), " crosses another");
  }

  [[nodiscard]] bool cross(const Segment &e, const Segment &f) const {
    const auto parts = [this](const Segment &line, const Segment &ends) {
      const Vector<2> a = seen(line[0]), b = seen(line[1]);
      return static_cast<int>(orientation(a, b, seen(ends[0]))) *
                 static_cast<int>(orientation(a, b, seen(ends[1]))) <
             0;
    };
    return parts(e, f) && parts(f, e);
  }

  /// A point of the facet between the ends of an edge, `none` if there is none.
  [[nodiscard]] Index point_on(const Segment &edge) const {
    const Vector<2> a = seen(edge[0]), b = seen(edge[1]);
    for (const Index v : own_) {
      const Vector<2> x = seen(v);
      if (v != edge[0] && v != edge[1] &&
          orientation(a, b, x) == Orientation::degenerate &&
          std::min(a[0], b[0]) <= x[0] && x[0] <= std::max(a[0], b[0]) &&
          std::min(a[1], b[1]) <= x[1] && x[1] <= std::max(a[1], b[1]))
        return v;
    }
    return none;
  }

  /// Floods from outside, across the loops.
  void fill() {
    std::vector<Cdt::Face_handle> reached{cdt_.infinite_face()};
    reached.front()->info() = {.is_reached = true};
    for (std::size_t k = 0; k < reached.size(); ++k)
      for (int i = 0; i < 3; ++i) {
        const Cdt::Face_handle next = reached[k]->neighbor(i);
        if (next->info().is_reached)
          continue;
        next->info() = across(reached[k], i);
        reached.push_back(next);
      }
  }

  /// What encloses the triangle on the other side of an edge.
  [[nodiscard]] Enclosure across(Cdt::Face_handle face, int i) const {
    if (!face->is_constrained(i))
      return face->info();
    const auto border = borders_.find(
        sorted(face->vertex(Cdt::ccw(i))->info(), face->vertex(Cdt::cw(i))->info()));
    if (border == borders_.end()) // an edge in the facet
      return face->info();
    const Enclosure side = border->second.beyond(face->info());
    if (side.in_hole && !side.in_outer)
      throw facet_error(facet_, "loop ", border->second.hole,
                        " lies outside of its outer loop");
    return side;
  }

  /// @throws std::invalid_argument if a point or an edge is not in what is filled.
  void require_inside(FacetLoops::Loop loop) const {
    if (loop.size() > 2)
      return;
    if (loop.size() == 1) {
      auto face = cdt_.incident_faces(handle_[loop[0]]);
      const auto start = face;
      do
        if (face->info().is_filled())
          return;
      while (++face != start);
      throw facet_error(facet_, "point ", loop[0], " lies outside");
    }
    Cdt::Face_handle face;
    int i = 0;
    if (!cdt_.is_edge(handle_[loop[0]], handle_[loop[1]], face, i) ||
        !(face->info().is_filled() || face->neighbor(i)->info().is_filled()))
      throw facet_error(facet_, "edge ", told(loop[0], loop[1]), " lies outside");
  }

  [[nodiscard]] std::vector<Facet<3>> filled() const {
    std::vector<Facet<3>> triangles;
    for (const Cdt::Face_handle face : cdt_.finite_face_handles())
      if (face->info().is_filled()) {
        Facet<3> triangle{face->vertex(0)->info(), face->vertex(1)->info(),
                          face->vertex(2)->info()};
        if (view_.is_mirrored())
          std::swap(triangle[1], triangle[2]);
        triangles.push_back(triangle);
      }
    if (triangles.empty())
      throw facet_error(facet_, "its loops enclose nothing");
    return triangles;
  }
};

FacetTriangulation::FacetTriangulation(std::span<const Vector<3>> points)
    : work_(std::make_unique<Work>(points)) {}

FacetTriangulation::~FacetTriangulation() = default;

std::vector<Facet<3>> FacetTriangulation::triangles(const FacetLoops &facets,
                                                    std::size_t facet,
                                                    const Vector<3> &normal,
                                                    std::span<const Segment> edges) {
  return work_->triangles(facets, facet, View(normal), edges);
}

} // namespace anistar::generate
