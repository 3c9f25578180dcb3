#include "generate/plane/plane_mesh.h"

namespace anistar::generate {
namespace {

/// What an edge of a triangle that is about to change leads to.
struct Link {
  HalfFacet across;
  Index wall;
};

Link link_of(const PlaneMesh &mesh, HalfFacet h) {
  return {mesh.opposite(h), mesh.wall(h)};
}

void join(PlaneMesh &mesh, HalfFacet h, const Link &link) {
  mesh.neighbours[h.cell()][h.facet()] = link.across;
  mesh.walls[h.cell()][h.facet()] = link.wall;
  if (link.across.exists())
    mesh.neighbours[link.across.cell()][link.across.facet()] = h;
}

Index add_cell(PlaneMesh &mesh, Index region) {
  const auto c = static_cast<Index>(mesh.cells.size());
  mesh.cells.emplace_back();
  mesh.neighbours.emplace_back();
  mesh.walls.push_back({none, none, none});
  mesh.regions.push_back(region);
  return c;
}

/// Makes the edge of h the other diagonal of its two triangles, of both of which the
/// vertex at h is then the first.
/// @returns the two edges opposite that vertex
std::array<HalfFacet, 2> flip(PlaneMesh &mesh, HalfFacet h) {
  const HalfFacet g = mesh.opposite(h);
  const Index c = h.cell(), e = g.cell(), v = mesh.apex(h), w = mesh.apex(g);
  const auto [a, b] = mesh.edge(h);
  // the quadrilateral v a w b; c becomes v a w, e becomes v w b
  const Link va = link_of(mesh, HalfFacet(c, (h.facet() + 2) % 3)),
             bv = link_of(mesh, HalfFacet(c, (h.facet() + 1) % 3)),
             wb = link_of(mesh, HalfFacet(e, (g.facet() + 2) % 3)),
             aw = link_of(mesh, HalfFacet(e, (g.facet() + 1) % 3));
  mesh.cells[c] = {v, a, w};
  mesh.cells[e] = {v, w, b};
  join(mesh, HalfFacet(c, 0), aw);
  join(mesh, HalfFacet(c, 2), va);
  join(mesh, HalfFacet(e, 0), wb);
  join(mesh, HalfFacet(e, 1), bv);
  join(mesh, HalfFacet(c, 1), {HalfFacet(e, 2), none});
  mesh.walls[e][2] = none;
  return {HalfFacet(c, 0), HalfFacet(e, 0)};
}

/// Flips what is not Delaunay around a new vertex (Lawson, Software for C1 surface
/// interpolation, 1977). It ends, as the vertex gains an edge by every flip.
void make_delaunay(PlaneMesh &mesh, std::vector<HalfFacet> suspects) {
  while (!suspects.empty()) {
    const HalfFacet h = suspects.back();
    suspects.pop_back();
    if (is_locally_delaunay(mesh, h))
      continue;
    const auto [one, other] = flip(mesh, h);
    suspects.push_back(one);
    suspects.push_back(other);
  }
}

Index last_vertex(const PlaneMesh &mesh) {
  return static_cast<Index>(mesh.points.size()) - 1;
}

/// The triangles at the two ends of an edge that a new vertex divides.
struct Halves {
  Index near_start, near_end;
};

Halves halve(PlaneMesh &mesh, HalfFacet h, Index v) {
  const Index c = h.cell(), apex = mesh.apex(h), wall = mesh.wall(h);
  const auto [a, b] = mesh.edge(h);
  const Link start = link_of(mesh, HalfFacet(c, (h.facet() + 2) % 3)),
             end = link_of(mesh, HalfFacet(c, (h.facet() + 1) % 3));
  const Index e = add_cell(mesh, mesh.regions[c]);
  mesh.cells[c] = {v, apex, a};
  mesh.cells[e] = {v, b, apex};
  join(mesh, HalfFacet(c, 0), start);
  join(mesh, HalfFacet(e, 0), end);
  join(mesh, HalfFacet(c, 2), {HalfFacet(e, 1), none});
  mesh.walls[e][1] = none;
  join(mesh, HalfFacet(c, 1), {HalfFacet(), wall});
  join(mesh, HalfFacet(e, 2), {HalfFacet(), wall});
  return {c, e};
}

} // namespace

bool is_in_circle(const PlaneMesh &mesh, Index cell, const Vector<2> &p) {
  constexpr SymmetricTensor<2> euclidean{{1, 0, 1}};
  return in_metric_sphere(euclidean, mesh.simplex(cell), p) == Side::inside;
}

bool is_locally_delaunay(const PlaneMesh &mesh, HalfFacet h) {
  const HalfFacet other = mesh.opposite(h);
  return mesh.wall(h) != none || !other.exists() ||
         !is_in_circle(mesh, h.cell(), mesh.points[mesh.apex(other)]);
}

Index insert_in_cell(PlaneMesh &mesh, Index cell) {
  const Index v = last_vertex(mesh);
  const auto [a, b, c] = mesh.cells[cell];
  std::array<Link, 3> links;
  for (std::size_t i = 0; i < 3; ++i)
    links[i] = link_of(mesh, HalfFacet(cell, i));
  const Index region = mesh.regions[cell], second = add_cell(mesh, region),
              third = add_cell(mesh, region);
  mesh.cells[cell] = {v, b, c};
  mesh.cells[second] = {v, c, a};
  mesh.cells[third] = {v, a, b};
  const std::array<Index, 3> made{cell, second, third};
  std::vector<HalfFacet> suspects;
  for (std::size_t i = 0; i < 3; ++i) {
    const HalfFacet h(made[i], 0);
    join(mesh, h, links[i]);
    join(mesh, HalfFacet(made[i], 1), {HalfFacet(made[(i + 1) % 3], 2), none});
    mesh.walls[made[i]][2] = none;
    suspects.push_back(h);
  }
  make_delaunay(mesh, std::move(suspects));
  return cell;
}

bool has_room_on_edge(const PlaneMesh &mesh, HalfFacet h, const Vector<2> &p) {
  for (const HalfFacet half : {h, mesh.opposite(h)}) {
    if (!half.exists())
      continue;
    const auto [a, b] = mesh.edge(half);
    const Vector<2> &apex = mesh.points[mesh.apex(half)];
    if (orientation(p, apex, mesh.points[a]) != Orientation::positive ||
        orientation(p, mesh.points[b], apex) != Orientation::positive)
      return false;
  }
  return true;
}

Index insert_on_edge(PlaneMesh &mesh, HalfFacet h) {
  const Index v = last_vertex(mesh);
  const HalfFacet g = mesh.opposite(h);
  const Halves here = halve(mesh, h, v);
  std::vector<HalfFacet> suspects{HalfFacet(here.near_start, 0),
                                  HalfFacet(here.near_end, 0)};
  if (g.exists()) {
    const Index wall = mesh.wall(HalfFacet(here.near_start, 1));
    const Halves there = halve(mesh, g, v); // its start is the end here
    join(mesh, HalfFacet(here.near_start, 1), {HalfFacet(there.near_end, 2), wall});
    join(mesh, HalfFacet(here.near_end, 2), {HalfFacet(there.near_start, 1), wall});
    suspects.push_back(HalfFacet(there.near_start, 0));
    suspects.push_back(HalfFacet(there.near_end, 0));
  }
  make_delaunay(mesh, std::move(suspects));
  return here.near_start;
}

} // namespace anistar::generate
