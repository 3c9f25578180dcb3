#include "volume/passes/edge_split.h"

#include "volume/mesh/vertex_star.h"

namespace anistar {
namespace {

/// A new vertex stands where the two halves have equal length when the size grows
/// geometrically along the edge, but not too near an end.
constexpr double nearest_to_end = .375;

/// Halves of an edge of a smooth curve leave it by a quarter of what the edge does.
constexpr double nearer = .4;

/// A facet is hidden from a vertex that would make a cell below this quality with it.
constexpr double hidden = 1e-5;

Vector<3> split_point(const Vertex<3> &p, const Vertex<3> &q) {
  const Vector<3> e = q.x - p.x;
  const double la = std::sqrt(quadratic<3>(p.M, e)),
               lb = std::sqrt(quadratic<3>(q.M, e));
  const double s =
      std::clamp(.5 * (.5 + lb / (la + lb)), nearest_to_end, 1 - nearest_to_end);
  return p.x + s * e;
}

} // namespace

bool EdgeSplit::split(Index cell, Index a, Index b, const NewVertexRule &rule,
                      const Acceptance &acceptance) {
  if (!run_.monitor.has_room(volume_.n_vertices())) {
    is_full_ = true;
    return false;
  }
  if (!shell_of(volume_.mesh, cell, a, b, shell_))
    return false;
  const EdgeFeature feature = feature_of(volume_, shell_);
  if (feature.is_frozen)
    return false;
  const Vector<3> x = volume_.surface.place(
      feature.dimension, feature.lies_on,
      split_point(volume_.mesh.vertex(a), volume_.mesh.vertex(b)));
  if (rule.follows_curve && !comes_nearer(feature, x))
    return false;
  const Index v = add_vertex(feature, x);
  if (!is_clear(v, rule.closest) || !enter(v, feature, acceptance)) {
    volume_.remove_vertex(v);
    return false;
  }
  if (feature.ridge != none)
    volume_.ridges.split(a, b, v);
  return true;
}

/// Whether halves follow a feature better: on what is no smooth feature at all they do
/// not, and splitting would have no end.
bool EdgeSplit::comes_nearer(const EdgeFeature &feature, const Vector<3> &x) const {
  const auto lift = [&](const Vector<3> &from, const Vector<3> &to) {
    return volume_.surface.lift(feature.dimension, feature.lies_on, from, to).norm();
  };
  const Vector<3> &a = volume_.mesh.vertex(shell_.a).x,
                  &b = volume_.mesh.vertex(shell_.b).x;
  const double whole = lift(a, b);
  return lift(a, x) < nearer * whole && lift(x, b) < nearer * whole;
}

Index EdgeSplit::add_vertex(const EdgeFeature &feature, const Vector<3> &x) {
  // the hint is that of the last vertex of the shell, which is near
  Index at = volume_.mesh.background_cell[shell_.a];
  const Vertex<3> vertex = volume_.background.vertex(x, at);
  const Index v = volume_.add_vertex(vertex, feature.dimension, feature.lies_on, at);
  std::vector<std::uint16_t> &strip = volume_.state.slabs.strip;
  strip[v] = strip[shell_.a];
  return v;
}

bool EdgeSplit::is_clear(Index v, double closest) const {
  if (closest > 0)
    for (std::size_t k = 0; k < shell_.n_ring(); ++k)
      if (!(fast_length(volume_.mesh.vertex(shell_.ring[k]), volume_.mesh.vertex(v)) >=
            closest))
        return false;
  return true;
}

bool EdgeSplit::enter(Index v, const EdgeFeature &feature,
                      const Acceptance &acceptance) {
  const std::array<Index, 2> lost{shell_.a, shell_.b};
  return operator_.replace(shell_.all(), v, lost, acceptance) ||
         (!volume_.surface.is_flat(feature.dimension, feature.lies_on) &&
          widen_shell(v) && operator_.replace(cavity_, v, lost, acceptance));
}

/// Makes a cavity of the cells of the shell, and those that hide their facets from v:
/// on a curved surface v may be off the cells of the edge that it splits.
bool EdgeSplit::widen_shell(Index v) {
  const Triangulation<3> &mesh = volume_.mesh;
  cavity_.assign(shell_.all().begin(), shell_.all().end());
  volume_.open_cells();
  for (Index c : cavity_)
    volume_.mark_cell(c);
  for (std::size_t i = 0; i < cavity_.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      const HalfFacet h(cavity_[i], k), beyond = mesh.opposite(h);
      const Facet<3> t = mesh.facet(h);
      const bool is_cut = std::count_if(t.begin(), t.end(), [&](Index u) {
                            return u == shell_.a || u == shell_.b;
                          }) == 2;
      if (is_cut || (beyond.exists() && volume_.is_marked_cell(beyond.cell())) ||
          shape_quality(mesh.vertex(t[0]), mesh.vertex(t[1]), mesh.vertex(t[2]),
                        mesh.vertex(v)) > hidden)
        continue;
      if (!beyond.exists() || mesh.constraint(h) != none ||
          cavity_.size() == Shell::capacity ||
          has_ridge(volume_, mesh.at(beyond.cell())))
        return false;
      volume_.mark_cell(beyond.cell());
      cavity_.push_back(beyond.cell());
    }
  return cavity_.size() > shell_.n_cells;
}

} // namespace anistar
