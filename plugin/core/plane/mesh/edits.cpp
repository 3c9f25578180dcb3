#include "plane/mesh/edits.h"

namespace anistar {
namespace {

/// A point nearer than this to an edge of its cell, relative to the cell's height over
/// it, is inserted into both cells of the edge.
constexpr double on_edge = 1e-6;
/// A cavity may grow by this many cells to see a point of a curve.
constexpr int max_growth = 8;

/// Adds the cells behind facets that x does not see, but never across a constraint.
bool grow_to_see(Triangulation<2> &mesh, Cavity &cavity, Index apex,
                 std::span<const HalfFacet> skipped, const Vector<2> &x) {
  for (int growth = 0; growth <= max_growth; ++growth) {
    cavity.bound(apex, skipped);
    HalfFacet hidden;
    for (HalfFacet h : cavity.facets()) {
      Simplex<2> s = mesh.simplex(h.cell());
      s[h.facet()] = x;
      if (!has_volume<2>(s)) {
        hidden = h;
        break;
      }
    }
    if (!hidden.exists())
      return growth == 0 || cavity.keeps_vertices();
    if (mesh.constraint(hidden) != none)
      return false;
    cavity.add(mesh.opposite(hidden).cell());
  }
  return false;
}

/// The two constrained edges of a curve vertex, in the direction of the curve.
struct OnCurve {
  HalfFacet into, out_of;
};

OnCurve curve_edges_at(const Workspace &w, Index v,
                       const std::vector<HalfFacet> &star) {
  OnCurve at;
  for (HalfFacet h : star)
    for (std::size_t k = 1; k < 3; ++k) {
      const HalfFacet spoke(h.cell(), (h.facet() + k) % 3);
      if (w.mesh.constraint(spoke) == none)
        continue;
      (w.curve_edge(spoke).v1 == v ? at.into : at.out_of) = spoke;
    }
  return at;
}

/// Bounds w.cavity for a vertex at x, on an edge. @returns false when not all of it can
/// be seen from there.
bool bound_split(Workspace &w, HalfFacet edge, const Vector<2> &x) {
  const HalfFacet other = w.mesh.opposite(edge);
  const HalfFacet boundary[1] = {edge};
  const std::span<const HalfFacet> skipped(boundary, other.exists() ? 0 : 1);
  w.cavity.clear();
  w.cavity.add(edge.cell());
  if (other.exists())
    w.cavity.add(other.cell());
  return grow_to_see(w.mesh, w.cavity, none, skipped, x);
}

/// Adds a vertex at x, near an edge.
Index add_near(Workspace &w, HalfFacet edge, const Vector<2> &x, Index feature) {
  Index cell = w.mesh.background_cell[w.mesh.facet(edge)[0]];
  const Vertex<2> vertex = w.background.vertex(x, cell);
  return w.mesh.add_vertex(vertex, feature, cell);
}

Index split_inside(Workspace &w, HalfFacet edge) {
  const auto [a, b] = w.mesh.facet(edge);
  const Vector<2> x = .5 * (w.mesh.vertex(a).x + w.mesh.vertex(b).x);
  if (!bound_split(w, edge, x))
    return none;
  const Index v = add_near(w, edge, x, Triangulation<2>::interior);
  w.cavity.fill(v);
  return v;
}

Index split_on_curve(Workspace &w, HalfFacet edge) {
  const CurveEdge whole = w.curve_edge(edge);
  const Curve &curve = w.curve(whole);
  if (curve.is_frozen || whole.ball != none)
    return none;
  const double t = middle(curve, whole.t0, whole.t1);
  const Vector<2> x = curve.at(t);
  const Index record = w.mesh.constraint(edge);
  if (!w.walls.is_clear(curve, w.mesh.vertex(whole.v0).x, whole.v0,
                        w.mesh.vertex(whole.v1).x, whole.v1, x, {&record, 1}) ||
      !bound_split(w, edge, x))
    return none;
  const Index v = add_near(w, edge, x, 1);
  auto &table = w.on_curves.curve_edges;
  const auto first = static_cast<Index>(table.size());
  table.push_back(whole.before(t, v));
  table.push_back(whole.after(t, v));
  w.walls.add(first, record);
  w.walls.add(first + 1, record);
  w.walls.remove(record);
  const SpokeConstraint spokes[2] = {{whole.v0, first}, {whole.v1, first + 1}};
  w.cavity.fill(v, spokes);
  return v;
}

/// Fills in what the removal of a vertex of a curve does to it. @returns false when
/// that is not valid.
bool merge_curve_edges(const Workspace &w, Collapse &collapse) {
  const Triangulation<2> &mesh = w.mesh;
  const Index v = collapse.vertex;
  const OnCurve at = curve_edges_at(w, v, collapse.star);
  if (!at.into.exists() || !at.out_of.exists())
    return false;
  const CurveEdge in = w.curve_edge(at.into), out = w.curve_edge(at.out_of);
  if (collapse.target != in.v0 && collapse.target != out.v1)
    return false;
  if (in.ball != none || out.ball != none)
    return false;
  if (in.v0 == out.v1 || w.curve(in).is_frozen ||
      relative_sagitta(w.curve(in), in.t0, out.t1) > w.hausdorff)
    return false;
  collapse.halves = {mesh.constraint(at.into), mesh.constraint(at.out_of)};
  if (!w.walls.is_clear(w.curve(in), mesh.vertex(in.v0).x, in.v0, mesh.vertex(v).x, v,
                        mesh.vertex(out.v1).x, collapse.halves))
    return false;
  collapse.merged = in.before(out.t1, out.v1);
  for (HalfFacet h : collapse.star) {
    const auto [a, b] = mesh.facet(h);
    if (mesh.constraint(h) != none && std::minmax(a, b) == std::minmax(in.v0, out.v1))
      return false; // another curve runs there
  }
  const Index far = collapse.target == in.v0 ? out.v1 : in.v0;
  collapse.spokes.push_back({far, none});
  for (HalfFacet edge : {at.into, at.out_of})
    if (!mesh.opposite(edge).exists())
      collapse.skipped.push_back(edge);
  return true;
}

} // namespace

bool encroaches(const Triangulation<2> &mesh, const Vertex<2> &p, HalfFacet edge) {
  if (mesh.constraint(edge) == none)
    return false;
  const auto [a, b] = mesh.facet(edge);
  const Vector<2> u = mesh.vertex(a).x - p.x, v = mesh.vertex(b).x - p.x;
  return product<2>(p.M, u).dot(v) < 0;
}

Index insert_in_cell(Triangulation<2> &mesh, Cavity &cavity, Index cell,
                     const Vertex<2> &vertex, Index background_cell) {
  const Simplex<2> s = mesh.simplex(cell);
  const double area = cross(s[1] - s[0], s[2] - s[0]);
  cavity.clear();
  cavity.add(cell);
  for (std::size_t i = 0; i < 3; ++i) {
    const double part =
        cross(s[(i + 2) % 3] - s[(i + 1) % 3], vertex.x - s[(i + 1) % 3]);
    if (part > on_edge * area)
      continue;
    if (mesh.constraint(HalfFacet(cell, i)) != none)
      return none;
    cavity.add(mesh.opposite(HalfFacet(cell, i)).cell());
  }
  cavity.bound(none);
  if (!cavity.is_star_shaped(vertex.x))
    return none;
  const Index v = mesh.add_vertex(vertex, Triangulation<2>::interior, background_cell,
                                  cavity.slots());
  cavity.fill(v);
  return v;
}

Index split_edge(Workspace &w, HalfFacet edge) {
  return w.mesh.constraint(edge) != none ? split_on_curve(w, edge)
                                         : split_inside(w, edge);
}

bool bound_collapse(Workspace &w, Collapse &collapse) {
  Triangulation<2> &mesh = w.mesh;
  const Index dimension = mesh.feature[collapse.vertex];
  if (dimension == Triangulation<2>::corner)
    return false;
  collapse.skipped.clear();
  collapse.spokes.clear();
  star_of(mesh, collapse.vertex, collapse.star);
  if (dimension == 1 && !merge_curve_edges(w, collapse))
    return false;
  w.cavity.clear();
  for (HalfFacet h : collapse.star)
    w.cavity.add(h.cell());
  w.cavity.bound(collapse.target, collapse.skipped);
  return !w.cavity.facets().empty() &&
         w.cavity.is_star_shaped(mesh.vertex(collapse.target).x);
}

void fill_collapse(Workspace &w, Collapse &collapse) {
  if (!collapse.spokes.empty()) {
    collapse.spokes.front().constraint =
        static_cast<Index>(w.on_curves.curve_edges.size());
    w.on_curves.curve_edges.push_back(collapse.merged);
    w.walls.add(collapse.spokes.front().constraint, collapse.halves[0]);
    for (Index gone : collapse.halves)
      w.walls.remove(gone);
  }
  w.cavity.fill(collapse.target, collapse.spokes);
  w.mesh.vertex_cell[collapse.vertex] = none;
}

} // namespace anistar
