#include "generate/repair/arrangement.h"

#include "generate/checking/contact.h"
#include "generate/checking/pieces.h"
#include "search/box_tree.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Projection_traits_3.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <map>
#include <set>

namespace anistar::generate {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Plane = CGAL::Projection_traits_3<Kernel>;
using Cuts = CGAL::Constrained_Delaunay_triangulation_2<Plane, CGAL::Default,
                                                        CGAL::Exact_intersections_tag>;

/// Corners of what a triangle has in common with another: a point, a segment, a
/// polygon.
using Common = std::vector<Point>;

struct CommonOf {
  Common operator()(const Point &p) const { return {p}; }
  Common operator()(const Kernel::Segment_3 &s) const {
    return {s.source(), s.target()};
  }
  Common operator()(const Triangle &t) const { return {t[0], t[1], t[2]}; }
  Common operator()(const Common &polygon) const { return polygon; }
};

/// Cuts triangles by those that they meet.
class Arrangement {
public:
  Arrangement(std::span<const Vector<3>> points, std::span<const Facet<3>> triangles)
      : pieces_(pieces_of(complex_of(points, triangles), {})) {
    out_.points.assign(points.begin(), points.end());
    exact_.reserve(points.size());
    for (const Vector<3> &x : points)
      exact_.emplace_back(x[0], x[1], x[2]);
    for (const Piece &piece : pieces_.pieces)
      for (const Index v : piece.points())
        numbers_.try_emplace(exact_[v], v);
  }

  TriangleSoup cut(Monitor &monitor) {
    const std::vector<Piece> &pieces = pieces_.pieces;
    find_meetings(monitor);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      monitor.insist(0);
      if (met_[k].empty())
        add(pieces[k].corners, k);
      else
        cut(k);
    }
    return std::move(out_);
  }

private:
  Pieces pieces_;
  std::vector<Point> exact_;
  std::map<Point, Index> numbers_;
  std::vector<std::vector<Index>> met_; ///< the pieces that each one meets
  std::set<std::array<Index, 3>> known_;
  TriangleSoup out_;

  static Plc complex_of(std::span<const Vector<3>> points,
                        std::span<const Facet<3>> triangles) {
    return {{points.begin(), points.end()},
            {triangles.begin(), triangles.end()},
            std::vector<Index>(triangles.size(), 0),
            {}};
  }

  void find_meetings(Monitor &monitor) {
    const std::vector<Piece> &pieces = pieces_.pieces;
    met_.resize(pieces.size());
    std::vector<Box<3>> boxes(pieces.size());
    for (std::size_t k = 0; k < pieces.size(); ++k)
      for (const Index v : pieces[k].points())
        boxes[k].extend(out_.points[v]);
    const BoxTree<3> tree(boxes);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      monitor.insist(0);
      tree.meeting(boxes[k], [&](Index j) {
        if (std::cmp_less_equal(j, k))
          return true;
        const Contact contact = meeting_of(out_.points, pieces[k], pieces[j]).contact;
        if (contact != Contact::none && contact != Contact::repeated) {
          met_[k].push_back(j);
          met_[j].push_back(static_cast<Index>(k));
        }
        return true;
      });
    }
    for (std::vector<Index> &met : met_)
      std::sort(met.begin(), met.end());
  }

  [[nodiscard]] Triangle triangle(std::size_t k) const {
    const auto &[a, b, c] = pieces_.pieces[k].corners;
    return {exact_[a], exact_[b], exact_[c]};
  }

  void cut(std::size_t k) {
    const Triangle whole = triangle(k);
    const Kernel::Vector_3 normal = whole.supporting_plane().orthogonal_vector();
    Cuts cuts{Plane(normal)};
    for (int i = 0; i < 3; ++i)
      cuts.insert_constraint(whole[i], whole[(i + 1) % 3]);
    for (const Index j : met_[k]) {
      const auto common =
          CGAL::intersection(whole, triangle(static_cast<std::size_t>(j)));
      if (common)
        insert(boost::apply_visitor(CommonOf{}, *common), cuts);
    }
    for (const auto face : cuts.finite_face_handles()) {
      std::array<Index, 3> corners;
      for (int i = 0; i < 3; ++i)
        corners[static_cast<std::size_t>(i)] = number(face->vertex(i)->point());
      add(corners, k);
    }
  }
  static void insert(const Common &common, Cuts &cuts) {
    if (common.size() == 1)
      cuts.insert(common.front());
    for (std::size_t i = 0; i < common.size() && common.size() > 1; ++i)
      cuts.insert_constraint(common[i], common[(i + 1) % common.size()]);
  }

  [[nodiscard]] Index number(const Point &p) {
    const auto [it, is_new] =
        numbers_.try_emplace(p, static_cast<Index>(out_.points.size()));
    if (is_new)
      out_.points.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()),
                               CGAL::to_double(p.z()));
    return it->second;
  }

  void add(const std::array<Index, 3> &corners, std::size_t k) {
    std::array<Index, 3> sorted = corners;
    std::sort(sorted.begin(), sorted.end());
    if (!known_.insert(sorted).second)
      return;
    out_.triangles.push_back(corners);
    out_.sources.push_back(pieces_.sources[k]);
  }
};

} // namespace

TriangleSoup arrangement_of(std::span<const Vector<3>> points,
                            std::span<const Facet<3>> triangles, Monitor &monitor) {
  return Arrangement(points, triangles).cut(monitor);
}

} // namespace anistar::generate
