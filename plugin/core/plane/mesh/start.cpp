#include "plane/mesh/start.h"

#include "base/range.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <map>
#include <numeric>
#include <optional>
#include <string>

namespace anistar {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using FaceBase = CGAL::Triangulation_face_base_with_info_2<
    Index, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_tag>;

/// Every retreat takes a point of the geometry or straightens a segment; far fewer
/// rounds than that are needed in practice.
constexpr int max_retreats = 100;

using EdgeKey = std::pair<Index, Index>;

/// Inserts points in the order of a curve that fills the plane, as CGAL's own insertion
/// of a range does, which cannot be interrupted.
void insert_points(Cdt &cdt, const std::vector<Kernel::Point_2> &points,
                   const std::function<void()> &look) {
  using Places = CGAL::Pointer_property_map<Kernel::Point_2>::const_type;
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  CGAL::spatial_sort(order.begin(), order.end(),
                     CGAL::Spatial_sort_traits_adapter_2<Kernel, Places>(
                         CGAL::make_property_map(points)));
  Cdt::Face_handle hint;
  for (std::size_t k : order) {
    look();
    const Cdt::Vertex_handle v = cdt.insert(points[k], hint);
    v->info() = static_cast<Index>(k);
    hint = v->face();
  }
}

Cdt insert_outline(const Outline &outline, const std::function<void()> &look) {
  std::vector<Kernel::Point_2> points;
  for (const Vertex<2> &vertex : outline.vertices) {
    require_finite(vertex.x);
    points.emplace_back(vertex.x[0], vertex.x[1]);
  }
  Cdt cdt;
  insert_points(cdt, points, look);
  std::vector<Cdt::Vertex_handle> handle(points.size());
  for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v)
    handle[v->info()] = v;
  for (std::size_t v = 0; v < handle.size(); ++v)
    if (handle[v] == nullptr)
      throw MeshingError("two points of the geometry coincide", outline.vertices[v].x);
  for (const CurveEdge &edge : outline.edges) {
    look();
    cdt.insert_constraint(handle[edge.v0], handle[edge.v1]);
  }
  return cdt;
}

struct Component {
  std::vector<Cdt::Face_handle> faces;
  std::vector<Index> walls;    ///< curve edges around it
  std::optional<Index> region; ///< what the walls say
  bool contradicts = false;
};

/// The parts of the plane between the constraints, each with what its walls say.
std::vector<Component> components(Cdt &cdt, const Outline &outline,
                                  const std::map<EdgeKey, Index> &edge_of,
                                  const Geometry &geometry,
                                  const std::function<void()> &look) {
  for (auto f = cdt.all_faces_begin(); f != cdt.all_faces_end(); ++f)
    f->info() = none;
  std::vector<Component> parts;
  for (auto seed = cdt.all_faces_begin(); seed != cdt.all_faces_end(); ++seed) {
    if (seed->info() != none)
      continue;
    const auto id = static_cast<Index>(parts.size());
    Component part;
    seed->info() = id;
    part.faces.push_back(seed);
    const auto claim = [&](Index region) {
      part.contradicts = part.contradicts || part.region.value_or(region) != region;
      part.region = part.region.value_or(region);
    };
    for (std::size_t k = 0; k < part.faces.size(); ++k) {
      look();
      const Cdt::Face_handle face = part.faces[k];
      if (cdt.is_infinite(face))
        claim(no_region);
      for (int i = 0; i < 3; ++i) {
        const Cdt::Face_handle next = face->neighbor(i);
        if (!face->is_constrained(i)) {
          if (next->info() == none) {
            next->info() = id;
            part.faces.push_back(next);
          }
          continue;
        }
        const Index a = face->vertex(Cdt::ccw(i))->info(),
                    b = face->vertex(Cdt::cw(i))->info();
        const Index e = edge_of.at({std::min(a, b), std::max(a, b)});
        const CurveEdge &edge = outline.edges[e];
        const Curve &curve = geometry.curves[edge.curve];
        claim(edge.v0 == a ? curve.left : curve.right);
        part.walls.push_back(e);
      }
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

MeshOnCurves extract(const Outline &outline, const std::vector<Component> &parts,
                     const std::map<EdgeKey, Index> &edge_of) {
  MeshOnCurves out;
  Triangulation<2> &mesh = out.mesh;
  out.curve_edges = outline.edges;
  for (std::size_t v = 0; v < outline.vertices.size(); ++v)
    (void)mesh.add_vertex(outline.vertices[v], outline.feature[v],
                          outline.background[v]);
  for (const Component &part : parts)
    if (part.region.value_or(no_region) != no_region)
      for (const Cdt::Face_handle &face : part.faces) {
        const Index c = mesh.add_cell();
        for (int i = 0; i < 3; ++i)
          mesh.at(c)[i] = face->vertex(i)->info();
        mesh.region[c] = *part.region;
        mesh.constraints[c].fill(none);
      }
  mesh.neighbours = adjacency<2>(mesh.cells, mesh.vertices.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (std::size_t i = 0; i < 3; ++i) {
      mesh.vertex_cell[mesh.cells[c][i]] = static_cast<Index>(c);
      const Facet<2> e = facet_of<2>(mesh.cells[c], i);
      const auto found = edge_of.find({std::min(e[0], e[1]), std::max(e[0], e[1])});
      if (found != edge_of.end())
        mesh.constraints[c][i] = found->second;
    }
  return out;
}

/// Where an edge begins, for a message.
Vector<2> place_of(const Outline &outline, Index e) {
  const CurveEdge &edge = outline.edges[e];
  return outline.vertices[edge.v0].x;
}

void resolve_conflicts(Geometry &geometry, const Background<2> &background,
                       Outline &outline, const std::function<void()> &look) {
  for (int round = 0; round < max_retreats; ++round) {
    const std::vector<Index> clashing = conflicts(outline, look);
    if (clashing.empty())
      return;
    if (!retreat(geometry, background, outline, clashing, look)) {
      throw MeshingError("the facets of the geometry cross",
                         place_of(outline, clashing.front()));
    }
  }
  throw MeshingError(
      "after " + std::to_string(max_retreats) +
          " retreats to the polyline the curves of the geometry still cross",
      place_of(outline, conflicts(outline, look).front()));
}

/// The curve edges that keep a free point out of its region.
std::vector<Index> misplaced(const Cdt &cdt, const std::vector<Component> &parts,
                             const Geometry &geometry, const Outline &outline) {
  std::vector<Index> found;
  std::map<Index, Index> wanted;
  for (const auto &[point, region] : outline.free_points)
    wanted[point] = region;
  for (auto v = cdt.finite_vertices_begin();
       v != cdt.finite_vertices_end() && !wanted.empty(); ++v) {
    const auto free = wanted.find(v->info());
    if (free == wanted.end())
      continue;
    const Component &part = parts[v->face()->info()];
    if (part.region.value_or(no_region) == free->second)
      continue;
    const auto &x = outline.vertices[v->info()].x;
    const std::vector<Index> before = edges_before(geometry, outline, x);
    const std::vector<Index> &blamed = before.empty() ? part.walls : before;
    found.insert(found.end(), blamed.begin(), blamed.end());
  }
  return found;
}

} // namespace

MeshOnCurves triangulate(Geometry &geometry, const Background<2> &background,
                         Outline outline, const std::function<void()> &look) {
  std::vector<Index> wrong;
  for (int round = 0; round < max_retreats; ++round) {
    resolve_conflicts(geometry, background, outline, look);
    Cdt cdt = insert_outline(outline, look);
    std::map<EdgeKey, Index> edge_of;
    for (std::size_t e = 0; e < outline.edges.size(); ++e) {
      const auto [a, b] = std::minmax(outline.edges[e].v0, outline.edges[e].v1);
      edge_of[{a, b}] = static_cast<Index>(e);
      look();
    }
    const auto parts = components(cdt, outline, edge_of, geometry, look);
    wrong = misplaced(cdt, parts, geometry, outline);
    for (const Component &part : parts)
      if (part.contradicts)
        wrong.insert(wrong.end(), part.walls.begin(), part.walls.end());
    if (wrong.empty())
      return extract(outline, parts, edge_of);
    std::sort(wrong.begin(), wrong.end());
    wrong.erase(std::unique(wrong.begin(), wrong.end()), wrong.end());
    if (!retreat(geometry, background, outline, wrong, look))
      break;
  }
  throw MeshingError("the facets of the geometry do not enclose its regions",
                     place_of(outline, wrong.front()));
}

} // namespace anistar
