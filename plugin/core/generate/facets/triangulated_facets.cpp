#include "generate/facets/triangulated_facets.h"

#include "generate/facets/facet_error.h"
#include "generate/facets/facet_plane.h"
#include "generate/facets/facet_triangulation.h"

#include <algorithm>

namespace anistar::generate {
namespace {

/// The given edges between points of one facet after the other.
class EdgesWithin {
public:
  EdgesWithin(std::size_t n_points, std::span<const Segment> edges)
      : edges_(edges.begin(), edges.end()), facet_of_(n_points, none) {
    for (Segment &edge : edges_)
      std::sort(edge.begin(), edge.end());
    std::sort(edges_.begin(), edges_.end());
  }

  [[nodiscard]] std::vector<Segment> operator()(FacetLoops::Loop points, Index facet) {
    std::vector<Segment> within;
    if (edges_.empty())
      return within;
    for (const Index v : points)
      facet_of_[v] = facet;
    for (const Index v : points) {
      auto edge = std::lower_bound(edges_.begin(), edges_.end(), Segment{v, none});
      for (; edge != edges_.end() && (*edge)[0] == v; ++edge)
        if (facet_of_[(*edge)[1]] == facet)
          within.push_back(*edge);
    }
    return within;
  }

private:
  std::vector<Segment> edges_;
  PerVertex<Index> facet_of_; ///< the last one with this point
};

void require_loops(const FacetLoops &facets, std::size_t facet) {
  const std::size_t n_loops = facets.n_loops(facet);
  if (n_loops == 0)
    throw facet_error(facet, "it has no loop");
  if (facets.outer(facet).size() < 3)
    throw facet_error(facet, "its outer loop has ", facets.outer(facet).size(),
                      " points, it takes three");
  for (std::size_t k = 1; k < n_loops; ++k)
    if (facets.loop(facet, k).empty())
      throw facet_error(facet, "loop ", k, " has no points");
}

double deviation_of(const FacetPlane &plane, std::span<const Vector<3>> points,
                    FacetLoops::Loop own, std::size_t facet, double flatness) {
  double farthest = 0;
  for (const Index v : own) {
    const double distance = plane.distance(points[v]);
    if (distance > flatness)
      throw facet_error(facet, "it is not planar: point ", v, " lies ", distance,
                        " from the plane of its outer loop, more than ", flatness);
    farthest = std::max(farthest, distance);
  }
  return farthest;
}

} // namespace

TriangulatedFacets triangulated_facets(std::span<const Vector<3>> points,
                                       const FacetLoops &facets,
                                       std::span<const Segment> edges,
                                       double flatness) {
  TriangulatedFacets out;
  out.deviations.resize(facets.size(), 0.);
  FacetTriangulation triangulation(points);
  EdgesWithin edges_within(points.size(), edges);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    require_loops(facets, f);
    if (facets.is_triangle(f)) {
      const FacetLoops::Loop loop = facets.outer(f);
      if (loop[0] == loop[1] || loop[1] == loop[2] || loop[2] == loop[0])
        throw facet_error(f, "its three points are not different");
      out.triangles.push_back({loop[0], loop[1], loop[2]});
      out.triangle_facets.push_back(static_cast<Index>(f));
      continue;
    }
    const FacetLoops::Loop own = facets.points(f);
    const FacetPlane plane = FacetPlane::of(points, facets.outer(f));
    if (!plane.has_area())
      throw facet_error(f, "its outer loop encloses no area");
    out.deviations[f] = deviation_of(plane, points, own, f, flatness);
    const auto cut = triangulation.triangles(facets, f, plane.normal,
                                             edges_within(own, static_cast<Index>(f)));
    out.triangles.insert(out.triangles.end(), cut.begin(), cut.end());
    out.triangle_facets.resize(out.triangles.size(), static_cast<Index>(f));
  }
  return out;
}

} // namespace anistar::generate
