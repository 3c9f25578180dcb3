#include "generate/refinement/mesh/facet_walk.h"

namespace anistar::generate {
namespace {

constexpr std::size_t most_steps = 100000;

/// Of the sides that have the target beyond, the one through which a straight way from
/// the start leaves is the one that it crosses first.
struct Exit {
  std::size_t side = 0;
  double crossing = 2; ///< as a fraction of the way

  void consider(std::size_t k, double of_start, double of_target) {
    if (of_target >= 0)
      return;
    const double at = of_start / (of_start - of_target);
    if (at < crossing) {
      crossing = at;
      side = k;
    }
  }
  [[nodiscard]] bool exists() const { return crossing < 2; }
};

} // namespace

FacetWalk walk_in_facet(const WalledMesh &mesh, const PlcFaces &faces, HalfFacet start,
                        const Vector<3> &x) {
  const Index facet = mesh.wall(start);
  const Projection flat = faces.projection(facet);
  const Facet<3> first = mesh.facet(start);
  const Vector<2> target = flat(x),
                  origin = flat((mesh.points[first[0]] + mesh.points[first[1]] +
                                 mesh.points[first[2]]) /
                                3);
  FacetWalk walk{.wall = start};
  for (std::size_t step = 0; step < most_steps; ++step) {
    const Facet<3> f = mesh.facet(walk.wall);
    const std::array<Vector<2>, 3> p{flat(mesh.points[f[0]]), flat(mesh.points[f[1]]),
                                     flat(mesh.points[f[2]])};
    const Orientation turn = orientation(p[0], p[1], p[2]);
    if (turn == Orientation::degenerate)
      break;
    const double sign = turn == Orientation::positive ? 1 : -1;
    Exit exit;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector<2> &a = p[(k + 1) % 3], along = p[(k + 2) % 3] - a;
      exit.consider(k, sign * cross(along, Vector<2>(origin - a)),
                    sign * cross(along, Vector<2>(target - a)));
    }
    if (!exit.exists())
      return walk;
    const Segment edge{f[(exit.side + 1) % 3], f[(exit.side + 2) % 3]};
    if (mesh.segment_of(edge[0], edge[1]) != none) {
      walk.border = edge;
      return walk;
    }
    const HalfFacet next = mesh.next_wall({walk.wall, exit.side});
    if (!next.exists() || mesh.wall(next) != facet)
      break;
    walk.wall = next;
  }
  walk.is_lost = true;
  return walk;
}

Vector<3> put_on_wall(const WalledMesh &mesh, const PlcFaces &faces, HalfFacet wall,
                      const Vector<3> &x) {
  const Facet<3> f = mesh.facet(wall);
  const Vector<3> &a = mesh.points[f[0]];
  const Vector<3> n = (mesh.points[f[1]] - a).cross(mesh.points[f[2]] - a);
  const int axis = faces.projection(mesh.wall(wall)).axis;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Vector<3> on = x;
  if (n[axis] != 0)
    on[axis] = a[axis] - (n[u] * (x[u] - a[u]) + n[v] * (x[v] - a[v])) / n[axis];
  return on;
}

SpaceWalk walk_in_space(const WalledMesh &mesh, Index start, const Vector<3> &x) {
  const Simplex<3> s = mesh.simplex(start);
  const Vector<3> origin = .25 * (s[0] + s[1] + s[2] + s[3]);
  HalfFacet entry;
  Index c = start;
  for (std::size_t step = 0; step < most_steps; ++step) {
    Exit exit;
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(c, i);
      if (h == entry)
        continue;
      const Facet<3> f = mesh.facet(h);
      const Vector<3> &a = mesh.points[f[0]];
      const Vector<3> n = (mesh.points[f[1]] - a).cross(mesh.points[f[2]] - a);
      exit.consider(i, n.dot(origin - a), n.dot(x - a));
    }
    if (!exit.exists())
      return {c, {}};
    const HalfFacet through(c, exit.side);
    if (mesh.wall(through) != none)
      return {.wall = through};
    entry = mesh.opposite(through);
    c = entry.cell();
  }
  return {};
}

} // namespace anistar::generate
