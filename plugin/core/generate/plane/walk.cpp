#include "generate/plane/walk.h"

namespace anistar::generate {
namespace {

using Kind = Place::Kind;

bool is_behind(const PlaneMesh &mesh, HalfFacet h, const Vector<2> &p) {
  const auto [a, b] = mesh.edge(h);
  return orientation(mesh.points[a], mesh.points[b], p) == Orientation::negative;
}

bool is_on(const PlaneMesh &mesh, HalfFacet h, const Vector<2> &p) {
  const auto [a, b] = mesh.edge(h);
  return orientation(mesh.points[a], mesh.points[b], p) == Orientation::degenerate;
}

/// @pre p is not outside of the triangle.
Place place_in(const PlaneMesh &mesh, Index cell, const Vector<2> &p) {
  const std::array<bool, 3> on{is_on(mesh, HalfFacet(cell, 0), p),
                               is_on(mesh, HalfFacet(cell, 1), p),
                               is_on(mesh, HalfFacet(cell, 2), p)};
  for (std::size_t i = 0; i < 3; ++i) {
    if (on[(i + 1) % 3] && on[(i + 2) % 3])
      return {Kind::on_vertex, HalfFacet(cell, i)};
    if (on[i] && !on[(i + 1) % 3] && !on[(i + 2) % 3])
      return {Kind::on_edge, HalfFacet(cell, i)};
  }
  return {Kind::in_cell, HalfFacet(cell, 0)};
}

/// A straight line through the plane. What it goes through exactly is taken to be on
/// its left, as if the line were moved by less than any distance.
class Ray {
public:
  Ray(const PlaneMesh &mesh, const Vector<2> &from, const Vector<2> &to)
      : mesh_(mesh), from_(from), to_(to) {}

  [[nodiscard]] bool has_on_left(Index v) const {
    return orientation(from_, to_, mesh_.points[v]) != Orientation::negative;
  }
  /// The edge through which it leaves the triangle in which it starts.
  [[nodiscard]] HalfFacet first_exit(Index cell) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (const auto [a, b] = mesh_.edge(HalfFacet(cell, i));
          !has_on_left(a) && has_on_left(b))
        return HalfFacet(cell, i);
    return HalfFacet(cell, 0);
  }
  /// The edge through which it leaves the triangle that it has entered.
  [[nodiscard]] HalfFacet exit(HalfFacet entry) const {
    const std::size_t turn = has_on_left(mesh_.apex(entry)) ? 1 : 2;
    return HalfFacet(entry.cell(), (entry.facet() + turn) % 3);
  }

private:
  const PlaneMesh &mesh_;
  const Vector<2> &from_, &to_;
};

} // namespace

Place walk_to(const PlaneMesh &mesh, Index cell, const Vector<2> &p, Walls walls) {
  const Simplex<2> s = mesh.simplex(cell);
  const Vector<2> start = (s[0] + s[1] + s[2]) / 3;
  const Ray ray(mesh, start, p);
  HalfFacet exit = ray.first_exit(cell);
  for (std::size_t step = 0; step <= mesh.cells.size(); ++step) {
    if (!is_behind(mesh, exit, p)) {
      // where the line passes through a vertex, or the start was rounded, p may be
      // behind another edge
      std::size_t i = 0;
      while (i < 3 && !is_behind(mesh, HalfFacet(exit.cell(), i), p))
        ++i;
      if (i == 3)
        return place_in(mesh, exit.cell(), p);
      exit = HalfFacet(exit.cell(), i);
    }
    const HalfFacet entry = mesh.opposite(exit);
    if (!entry.exists() || (walls == Walls::stop && mesh.wall(exit) != none))
      return {Kind::beyond, exit};
    exit = ray.exit(entry);
  }
  return {Kind::beyond, exit};
}

} // namespace anistar::generate
