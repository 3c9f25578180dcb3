#include "volume/stars/vertex_mover.h"

#include "base/ellipse_sampler.h"

namespace anistar {
namespace {

/// Distances at which places are tried.
constexpr double radii[] = {.3, .15, .07};
/// Edges at the vertex stay within these lengths.
constexpr double shortest = .55, longest = 1.7;
/// A move must bring so much.
constexpr double least_gain = .01;

} // namespace

bool VertexMover::move(Index v, const MoveDemand &demand, CounterRandom &random) {
  Triangulation<3> &mesh = volume_.mesh;
  if (mesh.feature[v] == Triangulation<3>::corner)
    return false;
  star_of(volume_, v, star_);
  if (!is_free(v))
    return false;
  const ScoredPlace best = best_place(v, demand.trials, random);
  if (!best.exists() || best.score.failing > demand.most_failing ||
      best.score.cost > -least_gain ||
      !insertion_.gather(best.p, star_, {shortest, {none, none}, v}))
    return false;
  const Vertex<3> from = mesh.vertex(v);
  mesh.vertex(v) = best.p;
  if (!operator_.replace(insertion_.cells(), v, {none, none},
                         {.floor = quality_floor, .longest = longest})) {
    mesh.vertex(v) = from;
    return false;
  }
  mesh.background_cell[v] = best.background;
  return true;
}

/// Whether the facets at v lie in planes, and may move. @pre star_ is the star of v.
bool VertexMover::is_free(Index v) const {
  const Triangulation<3> &mesh = volume_.mesh;
  const Index dimension = volume_.feature(v);
  if (dimension == Triangulation<3>::interior)
    return true;
  if (!volume_.surface.is_flat(dimension, volume_.support_of(v)))
    return false;
  for (Index c : star_)
    for (std::size_t i = 0; i < 4; ++i) {
      const Index wall = mesh.constraint(HalfFacet(c, i));
      if (wall == none || mesh.at(c)[i] == v)
        continue;
      const Patch &patch = volume_.surface.patch(wall);
      if (!patch.is_planar || patch.is_frozen)
        return false;
    }
  return true;
}

ScoredPlace VertexMover::best_place(Index v, int trials, CounterRandom &random) {
  const Vertex<3> &here = volume_.mesh.vertex(v);
  const EllipseSampler<3> ellipse(here.M);
  ScoredPlace best;
  const auto consider = [&](const Vector<3> &x) {
    if (!is_in_range<3>(x))
      return;
    ScoredPlace found{{}, {}, star_.front(), volume_.mesh.background_cell[v]};
    found.p = volume_.background.vertex(x, found.background);
    if (!insertion_.gather(found.p, star_, {shortest, {none, none}, v}))
      return;
    found.score = insertion_.score(sigma_0_, std::numeric_limits<double>::infinity());
    if (found.score.is_better(best.score))
      best = found;
  };
  consider(here.x);
  for (const double radius : radii)
    for (int k = 0; k < trials; ++k)
      consider(volume_.surface.place(volume_.feature(v), volume_.support_of(v),
                                     here.x + ellipse.step(radius, random)));
  return best;
}

} // namespace anistar
