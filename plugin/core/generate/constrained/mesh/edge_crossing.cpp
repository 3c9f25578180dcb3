#include "generate/constrained/mesh/edge_crossing.h"

#include <algorithm>

namespace anistar::generate {
namespace {

/// Whether the ray from the vertex at place i of a cell to a point leaves it through
/// the opposite facet, or along its border.
bool is_left_by_ray(const ExactPoints &points, const GhostMesh &mesh, HalfFacet h,
                    Index to) {
  const Index from = mesh.apex(h);
  const auto [a, b, c] = mesh.facet(h);
  const auto is_inside = [&](Index one, Index other) {
    return points.orientation(from, other, one, to) != Orientation::negative;
  };
  return is_inside(a, b) && is_inside(b, c) && is_inside(c, a);
}

/// The facet through which the edge leaves the star of its first end.
HalfFacet way_out(const ExactPoints &points, const GhostMesh &mesh, Index from,
                  Index to) {
  for (const Index c : mesh.star(from)) {
    if (mesh.is_ghost(c))
      continue;
    const HalfFacet h(c, *mesh.index_of(c, from));
    if (is_left_by_ray(points, mesh, h, to))
      return h;
  }
  return {};
}

/// Another facet of the cell through which the edge goes on.
HalfFacet next_facet(const ExactPoints &points, const GhostMesh &mesh,
                     HalfFacet entered, Index from, Index to) {
  for (std::size_t i = 0; i < 4; ++i) {
    const HalfFacet h(entered.cell(), i);
    if (h == entered)
      continue;
    const auto [a, b, c] = mesh.facet(h); // the cell is above
    const auto is_inside = [&](Index one, Index other) {
      return points.orientation(from, other, one, to) != Orientation::negative;
    };
    if (points.orientation(a, b, c, to) == Orientation::negative && is_inside(a, b) &&
        is_inside(b, c) && is_inside(c, a))
      return h;
  }
  return {};
}

} // namespace

std::vector<Index> vertices_between(const ExactPoints &points, const GhostMesh &mesh,
                                    Index from, Index to) {
  std::vector<Index> found;
  const auto note = [&](Index c) {
    for (const Index v : mesh.cell(c))
      if (v != from && v != to && v != ghost)
        found.push_back(v);
  };
  HalfFacet out = way_out(points, mesh, from, to);
  for (std::size_t step = 0; out.exists() && step < mesh.n_cells(); ++step) {
    note(out.cell());
    const HalfFacet entered = mesh.opposite(out);
    note(entered.cell());
    if (mesh.is_ghost(entered.cell()) || mesh.index_of(entered.cell(), to))
      break;
    out = next_facet(points, mesh, entered, from, to);
  }
  std::ranges::sort(found);
  const auto rest = std::ranges::unique(found);
  found.erase(rest.begin(), rest.end());
  return found;
}

} // namespace anistar::generate
