#include "mesh/mesh_walk.h"

namespace anistar {
namespace {

/// Points are looked for near the cell where the walk starts; in 2D circumcentres of
/// long cells may be far away.
template <std::size_t d> constexpr int max_steps = d == 2 ? 10000 : 200;

/// The facet of a cell, looked at from the k-th on, that x lies behind; not the one the
/// walk came through.
template <std::size_t d>
[[nodiscard]] HalfFacet facet_before(const Triangulation<d> &mesh, Index cell,
                                     const Vector<d> &x, std::size_t k,
                                     HalfFacet came) {
  const Simplex<d> s = mesh.simplex(cell);
  for (std::size_t i = 0; i <= d; ++i) {
    const HalfFacet h(cell, (k + i) % (d + 1));
    if (h == came)
      continue;
    Simplex<d> replaced = s;
    replaced[h.facet()] = x;
    if (orientation<d>(replaced) == Orientation::negative)
      return h;
  }
  return {};
}

} // namespace

template <std::size_t d>
Walk walk_to(const Triangulation<d> &mesh, Index start, const Vector<d> &x,
             const VertexRange &range) {
  Index cell = start;
  HalfFacet came;
  for (int step = 0; step < max_steps<d>; ++step) {
    const HalfFacet cross = facet_before<d>(mesh, cell, x, step, came);
    if (!cross.exists())
      return {cell, {}};
    if (mesh.constraint(cross) != none)
      return {none, cross};
    came = mesh.opposite(cross);
    cell = came.cell();
    if (!range.contains(mesh.at(cell)))
      return {};
  }
  return {};
}

template Walk walk_to(const Triangulation<2> &, Index, const Vector<2> &,
                      const VertexRange &);
template Walk walk_to(const Triangulation<3> &, Index, const Vector<3> &,
                      const VertexRange &);

} // namespace anistar
