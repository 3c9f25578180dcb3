#include "generate/repair/wrap.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

namespace anistar::generate {

TriangleSoup wrapped(std::span<const Vector<3>> points,
                     std::span<const Facet<3>> triangles, const WrapSizes &sizes) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  using Surface = CGAL::Surface_mesh<Point>;
  std::vector<Point> corners;
  for (const Vector<3> &x : points)
    corners.emplace_back(x[0], x[1], x[2]);
  std::vector<std::array<std::size_t, 3>> faces;
  for (const auto &[a, b, c] : triangles)
    faces.push_back({static_cast<std::size_t>(a), static_cast<std::size_t>(b),
                     static_cast<std::size_t>(c)});
  Surface surface;
  CGAL::alpha_wrap_3(corners, faces, sizes.alpha, sizes.offset, surface);

  TriangleSoup out;
  std::vector<Index> number(surface.num_vertices());
  for (const auto v : surface.vertices()) {
    number[v.idx()] = static_cast<Index>(out.points.size());
    const Point &p = surface.point(v);
    out.points.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : surface.faces()) {
    Facet<3> triangle;
    std::size_t k = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(f)))
      triangle[k++] = number[v.idx()];
    out.triangles.push_back(triangle);
  }
  return out;
}

} // namespace anistar::generate
