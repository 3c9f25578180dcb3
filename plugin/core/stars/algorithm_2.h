#pragma once
// Algorithms 2 to 5 of Boissonnat, Wormser, Yvinec (RR-7712 v2, sections 4 and 7.1) on
// one valid mesh of triangles or of tetrahedra: the rounds of insertions, and
// Pick_valid.
//
// Differs from the paper: one valid mesh is kept instead of the star sets; the
// simplices of the star S_v are the cells that are Delaunay in M_v, those of the
// surface star T_v the facets of surfaces with an empty M_v-surface ball. Pick_valid
// takes the best of a bounded number of points when none is valid. A round treats many
// cells. When it does not end consistent, the best mesh seen is left.

#include "base/ellipse_sampler.h"
#include "base/run.h"
#include "mesh/mesh_walk.h"
#include "stars/bad_facets.h"

#include <optional>
#include <utility>

namespace anistar {

/// A point, what it would bring, and where it was looked for.
template <std::size_t d, class Score> struct ScoredPoint {
  Score score{};
  Vertex<d> p{};
  Index seed = none;       ///< a cell of its cavity
  Index background = none; ///< where its metric was found

  [[nodiscard]] bool exists() const { return seed != none; }
};

/// What is thought of one point. Without a score it cannot be inserted.
template <class Score> struct Judgement {
  std::optional<Score> score;
  HalfFacet wall; ///< a constrained facet that it encroaches upon
};

/// The best point, and a constrained facet that one of the points encroaches upon or
/// lies beyond.
template <std::size_t d, class Score> struct Picked {
  ScoredPoint<d, Score> best;
  HalfFacet wall;
};

/// Pick_valid (Algorithm 3): the best of points of the picking region of a bad cell,
/// the ball of radius delta r about its circumcentre.
/// @param judge starts_at_centre(rule): whether the circumcentre comes first;
/// judge(p, cell, radius): what a point in a cell would bring, counting configurations
/// up to this circumradius; is_enough(rule, picked): whether the search may end
template <std::size_t d, class Judge>
[[nodiscard]] auto pick_valid(const Triangulation<d> &mesh,
                              const Background<d> &background, const BadCell<d> &item,
                              const ConsistencyParameters &parameters,
                              CounterRandom random, Judge &judge) {
  const SymmetricTensor<d> M = mesh.vertex(item.star).M;
  const Circumsphere<d> ball = circumsphere<d>(M, mesh.simplex(item.cell));
  const EllipseSampler<d> ellipse(M);
  Picked<d, typename Judge::Score> picked;
  for (int k = 0; k < parameters.candidates && !judge.is_enough(item.rule, picked);
       ++k) {
    Vector<d> x = ball.centre;
    if (k > 0 || !judge.starts_at_centre(item.rule))
      x += ellipse.step(parameters.delta * ball.radius, random);
    const Walk at = walk_to(mesh, item.cell, x);
    if (at.wall.exists())
      picked.wall = at.wall;
    if (at.cell == none)
      continue;
    ScoredPoint<d, typename Judge::Score> found{
        {}, {}, at.cell, mesh.background_cell[item.star]};
    found.p = background.vertex(x, found.background);
    const auto judgement = judge.judge(found.p, at.cell, parameters.beta * ball.radius);
    if (judgement.wall.exists())
      picked.wall = judgement.wall;
    if (!judgement.score)
      continue;
    found.score = *judgement.score;
    if (!picked.best.exists() || found.score.is_better(picked.best.score))
      picked.best = found;
  }
  return picked;
}

/// What ends the rounds.
struct RoundBounds {
  int max_rounds;
  int patience = 0;         ///< rounds that bring nothing
  double most_vertices = 0; ///< the mesh may grow to

  /// Why no round follows on those done.
  [[nodiscard]] ConsistencyStop stop(bool is_consistent, int rounds, int without_gain,
                                     std::size_t n_vertices, Monitor &monitor) const {
    if (is_consistent)
      return ConsistencyStop::consistent;
    if (rounds == max_rounds)
      return ConsistencyStop::max_rounds;
    if (static_cast<double>(n_vertices) > most_vertices)
      return ConsistencyStop::max_growth;
    if (without_gain > patience)
      return ConsistencyStop::stalled;
    if (!monitor.keep_going(n_vertices, 0) ||
        !monitor.look(double(rounds) / max_rounds))
      return monitor.reason() == StopReason::max_seconds
                 ? ConsistencyStop::max_seconds
                 : ConsistencyStop::max_vertices;
    return ConsistencyStop::none_yet;
  }
};

template <std::size_t d>
[[nodiscard]] std::vector<BadCell<d>>
in_order_of_rules(const std::vector<BadCell<d>> &facets,
                  const std::vector<BadCell<d>> &cells) {
  std::vector<BadCell<d>> all;
  all.reserve(facets.size() + cells.size());
  std::merge(facets.begin(), facets.end(), cells.begin(), cells.end(),
             std::back_inserter(all),
             [](const BadCell<d> &a, const BadCell<d> &b) { return a.rule < b.rule; });
  return all;
}

/// Algorithms 2 and 4: rounds of insertions by the rules in their order until every
/// star is Delaunay in its own metric, or a bound ends them.
///
/// @tparam Rounds the changes of one dimension: mesh(), background(), n_vertices();
/// `d`, `max_rounds`; patience(n_bad); are_rules_everywhere(): other rules also for
/// cells that are consistent; treat(bad, counts, known): one round, after which `known`
/// is true of the mesh again; note(failing, best): hears the part of the cells that
/// fails after a round, and in the best mesh before; surface_stars(done): the facets
/// of its surfaces, when this part of the rounds is done; rounds_without_gain();
/// is_starting(): the mesh is too coarse to be judged, it is the best one, and may
/// grow; snapshot(), restore(snapshot)
/// @param known the answers for the mesh, which has no free cells; afterwards for the
/// mesh that is left
template <class Rounds>
[[nodiscard]] ConsistencyCounts
insert_until_consistent(Rounds &rounds, const Run &run,
                        const ConsistencyParameters &parameters, DelaunayBits &known) {
  constexpr std::size_t d = Rounds::d;
  struct Best {
    typename Rounds::Snapshot mesh;
    DelaunayBits known;
    double failing;
  };
  const auto seen = [&](double failing) {
    return Best{rounds.snapshot(), known, failing};
  };
  ConsistencyCounts counts;
  RoundBounds bounds{Rounds::max_rounds};
  const auto may_grow_from_here = [&] {
    bounds.most_vertices =
        (1 + parameters.max_growth) * static_cast<double>(rounds.n_vertices());
  };
  SurfaceStars<d> surface;
  // no cell is given for any number of facets
  const auto look_at_failing = [&] {
    surface = rounds.surface_stars(double(counts.rounds) / bounds.max_rounds);
    return failing_fraction(rounds.mesh(), known.bits) +
           surface.failing_fraction() / static_cast<double>(rounds.mesh().n_cells());
  };
  double failing = look_at_failing();
  std::optional<Best> best(seen(failing));
  may_grow_from_here();
  for (counts.rounds = 0;; ++counts.rounds) {
    const std::vector<BadCell<d>> bad = in_order_of_rules(
        bad_facets<d>(rounds.mesh(), rounds.background(), surface, parameters),
        bad_cells<d>(rounds.mesh(), rounds.background(), known.bits, parameters,
                     rounds.are_rules_everywhere()));
    bounds.patience = rounds.patience(bad.size());
    counts.stop = bounds.stop(bad.empty(), counts.rounds, rounds.rounds_without_gain(),
                              rounds.n_vertices(), run.monitor);
    if (counts.stop != ConsistencyStop::none_yet)
      break;
    rounds.treat(bad, counts, known);
    failing = look_at_failing();
    rounds.note(failing, best->failing);
    if (rounds.is_starting())
      may_grow_from_here();
    if (rounds.is_starting() || failing < best->failing) {
      best.reset(); // before the copy is made: a mesh is large
      best = seen(failing);
    }
  }
  if (failing > best->failing) {
    rounds.restore(std::move(best->mesh));
    known = std::move(best->known);
  }
  counts.ln_gamma_p90 = ln_gamma_p90(rounds.mesh(), known.bits);
  return counts;
}

} // namespace anistar
