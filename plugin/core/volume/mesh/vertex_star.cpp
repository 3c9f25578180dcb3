#include "volume/mesh/vertex_star.h"

#include "volume/mesh/cavity_operator.h"
#include "volume/mesh/cones.h"

namespace anistar {
namespace {

/// Whether the cells of a star stay out of the bodies that they touch in a vertex when
/// v goes to x.
bool keeps_bodies_apart(const Volume &volume, std::span<const Index> star, Index v,
                        const Vector<3> &x) {
  for (Index c : star)
    for (Index u : volume.mesh.at(c)) {
      if (u == v || !volume.fans_of(u))
        continue;
      Cone cone = cone_at(volume.mesh, volume.mesh.at(c), u);
      for (std::size_t k = 0; k < 3; ++k)
        if (cone.vertices[k] == v)
          cone.corners[k] = x;
      if (!is_apart_from_fans(volume, u, cone, star))
        return false;
    }
  return true;
}

} // namespace

bool keeps_surfaces(const Volume &volume, std::span<const Index> star, Index v,
                    const Vector<3> &x, double hausdorff_number) {
  const Triangulation<3> &mesh = volume.mesh;
  const Vertex<3> moved{x, mesh.vertex(v).M};
  const Vector<3> &from = mesh.vertex(v).x;
  Index seen = none;
  std::array<Index, 16> checked; ///< the edges of the surface, twice each
  std::size_t n_checked = 0;
  const auto first_seen = [&](Index end) {
    const auto last = checked.begin() + static_cast<std::ptrdiff_t>(n_checked);
    if (std::find(checked.begin(), last, end) != last)
      return false;
    if (n_checked < checked.size())
      checked[n_checked++] = end;
    return true;
  };
  Vector<3> normal = Vector<3>::Zero(); ///< of the surface, at x
  for (Index c : star) {
    if (!volume.is_walled(c))
      continue;
    const std::size_t at = mesh.local_index(c, v);
    for (std::size_t i = 0; i < 4; ++i) {
      const Index k = i == at ? none : mesh.constraint(HalfFacet(c, i));
      if (k == none)
        continue;
      std::array<Index, 2> ends{none, none}; // of the facet, besides v
      for (std::size_t j = 0; j < 4; ++j)
        if (j != i && j != at)
          ends[ends[0] == none ? 0 : 1] = mesh.at(c)[j];
      const Vector<3> &a = mesh.vertex(ends[0]).x, &b = mesh.vertex(ends[1]).x;
      const Vector<3> before = (b - a).cross(from - a), after = (b - a).cross(x - a);
      const Patch &patch = volume.surface.patch(k);
      if (k != seen) {
        seen = k;
        normal = volume.surface.normal(k, x, before);
      }
      const double side = normal.dot(before) < 0 ? -1 : 1;
      const double least = patch.is_planar
                               ? 0
                               : std::min(smallest_facet_cosine,
                                          side * normal.dot(before) / before.norm());
      if (!(side * normal.dot(after) > least * after.norm()))
        return false;
      if (!patch.is_planar && hausdorff_number > 0)
        for (Index end : ends)
          if (first_seen(end) &&
              volume.surface.strays(2, k, mesh.vertex(end), moved, hausdorff_number))
            return false;
    }
  }
  return volume.fans.empty() ||
         volume.surface.is_flat(volume.feature(v), volume.support_of(v)) ||
         keeps_bodies_apart(volume, star, v, x);
}

bool has_ridge(const Volume &volume, const Cell<3> &cell) {
  std::array<Index, 4> on{};
  std::size_t n = 0;
  for (Index v : cell)
    if (volume.feature(v) <= 1)
      on[n++] = v;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (volume.ridges.find(on[i], on[j]) != none)
        return true;
  return false;
}

namespace {

/// The balls of cells much larger than a unit reach far; no cavity of so many cells
/// has been of use.
constexpr std::size_t largest_cavity = 512;

/// Cells that a cavity may take, to be tested side by side.
class CavityCandidates {
public:
  [[nodiscard]] bool has_room() const { return balls_.size() + 4 <= cells_.size(); }
  void add(const Triangulation<3> &mesh, Index c, const Vector<3> &x) {
    const Simplex<3> s = mesh.simplex(c);
    cells_[balls_.size()] = c;
    balls_.add(s[0], s[1], s[2], s[3], x);
  }
  /// Moves those whose circumball contains the point to the cavity.
  void take(Volume &volume, const SymmetricTensor<3> &M, std::vector<Index> &cavity) {
    balls_.evaluate(M);
    for (std::size_t k = 0; k < balls_.size(); ++k)
      if (balls_.is_in_ball(k) && !volume.is_marked_cell(cells_[k]) &&
          !has_ridge(volume, volume.mesh.at(cells_[k]))) {
        volume.mark_cell(cells_[k]);
        cavity.push_back(cells_[k]);
      }
    balls_.clear();
  }

private:
  BallTests balls_;
  std::array<Index, BallTests::capacity> cells_;
};

} // namespace

void grow_cavity(Volume &volume, Index v, std::vector<Index> &star) {
  const Triangulation<3> &mesh = volume.mesh;
  const Vertex<3> &here = mesh.vertex(v);
  const std::size_t n_given = star.size();
  const std::size_t n_star = mesh.is_used(v) ? star.size() : 0;
  CavityCandidates candidates;
  std::size_t i = 0;
  do { // one layer of cells after another
    for (; i < star.size() && candidates.has_room(); ++i)
      for (std::size_t k = 0; k < 4; ++k) {
        const Index c = star[i];
        if (i < n_star && mesh.at(c)[k] != v)
          continue;
        const HalfFacet h(c, k), beyond = mesh.opposite(h);
        if (!beyond.exists() || volume.is_marked_cell(beyond.cell()) ||
            (volume.is_walled(c) && mesh.constraint(h) != none))
          continue;
        if (volume.slab && !volume.is_inside(mesh.apex(beyond))) {
          volume.is_put_off = true;
          return;
        }
        candidates.add(mesh, beyond.cell(), here.x);
      }
    candidates.take(volume, here.M, star);
  } while (i < star.size() && star.size() < largest_cavity);
  if (i < star.size())
    star.resize(n_given);
}

} // namespace anistar
