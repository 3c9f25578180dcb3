#include "volume/mesh/slab_team.h"
#include "volume/mesh/vertex_star.h"
#include "volume/mesh/vertex_trial.h"
#include "volume/passes/collapse.h"
#include "volume/passes/passes.h"

namespace anistar {
namespace {

/// Below this a star is stuck: a collapse may keep an edge of it that is too long.
constexpr double stuck_quality = .1;
/// An edge whose square in the metric of one end exceeds this times the bound is not
/// below the bound in the mean, whatever the other end says within reason.
constexpr double clearly_longer = 4;

/// Steps shorter than this, in the metric, are not worth a trial in a good star.
constexpr double smallest_step = .02, good_quality = .5;
/// Facets of less, twice the area in the metric, tell no place of their apex.
constexpr double smallest_facet = 1e-12;
/// Parts of the step to the ideal place that are tried.
constexpr double step_fractions[] = {1, .4};
/// Random trials for stars below this quality, within this radius.
constexpr double random_below = .4, random_radius = .2;
/// Moves may not take the worst cell below this, or below where it is but for
/// round-off.
constexpr double move_floor = .35, round_off = 1e-6;
/// Moves that raise the worst cell by `worst` may lower the mean quality of the star by
/// so much; others must raise the mean.
struct RequiredGain {
  double worst, mean_loss, mean;
};
constexpr RequiredGain any_gain{.worst = 1e-4, .mean_loss = .02, .mean = .002};
/// Of stars at rest: less is not worth what it undoes.
constexpr RequiredGain clear_gain{.worst = .02, .mean_loss = 0, .mean = .01};

/// Edges that a re-insertion may make.
constexpr double longest_reinserted = 1.6;

/// What one thread does of the pass.
class VertexImprovement {
public:
  /// @param since when changes are due
  /// @param is_placed per vertex: whether it waits only for its re-insertion
  VertexImprovement(Volume &volume, const Run &run, const VertexRule &rule,
                    std::uint32_t since, PerVertex<std::uint8_t> &is_placed)
      : volume_(volume), mesh_(volume.mesh), run_(run), rule_(rule), since_(since),
        is_placed_(is_placed), operator_(volume), collapse_(volume, operator_, run),
        trial_(volume, run.hausdorff.surface) {}

  VolumeCounts counts;

  void visit(Index v) {
    if (!mesh_.is_used(v) || volume_.vertex_clock[v] < since_)
      return;
    star_of(volume_, v, star_);
    if (is_placed_[v] == 0) {
      if (collapse_shortest(v) || volume_.is_put_off)
        return;
      move(v);
      is_placed_[v] = 1;
    }
    if (rule_.reinsert)
      reinsert(v);
  }

private:
  Volume &volume_;
  const Triangulation<3> &mesh_;
  const Run &run_;
  const VertexRule &rule_;
  std::uint32_t since_;
  PerVertex<std::uint8_t> &is_placed_;
  CavityOperator operator_;
  Collapse collapse_;
  VertexTrial trial_;
  std::vector<Index> star_; ///< of the vertex that is visited, marked

  [[nodiscard]] double worst_of_star() const {
    double worst = 1;
    for (Index c : star_)
      worst = std::min(worst, volume_.quality_of(c));
    return worst;
  }

  [[nodiscard]] bool collapse_shortest(Index v) {
    collapse_.gather(v, star_);
    const Index to = nearest(v);
    if (to == none)
      return false;
    const Acceptance acceptance{.floor = rule_.collapse_floor,
                                .longest = longest_kept(v),
                                .hausdorff_number = run_.hausdorff.surface};
    if (!collapse_.go_to(to, acceptance)) {
      star_of(volume_, v, star_); // the trial has used the marks
      return false;
    }
    ++counts.collapses;
    return true;
  }

  /// The vertex at the end of the shortest edge that is too short, where v may go to
  /// it; none otherwise.
  [[nodiscard]] Index nearest(Index v) {
    const Vertex<3> &here = mesh_.vertex(v);
    Index best = none;
    double shortest = rule_.shortest;
    volume_.open_vertices();
    volume_.mark_vertex(v);
    for (Index c : star_)
      for (Index u : mesh_.at(c)) {
        if (!volume_.mark_vertex(u))
          continue;
        const Vertex<3> &there = mesh_.vertex(u);
        const Vector<3> e = there.x - here.x;
        const double square = quadratic<3>(here.M, e);
        // a mean is not below both
        if (square > clearly_longer * shortest ||
            std::min(square, quadratic<3>(there.M, e)) >= shortest * shortest)
          continue;
        const double l = fast_length(here, there);
        if (l < shortest && collapse_.may_go_to(u)) {
          shortest = l;
          best = u;
        }
      }
    return best;
  }

  /// The bound of edges after a collapse.
  [[nodiscard]] double longest_kept(Index v) const {
    double longest = rule_.longest;
    if (worst_of_star() < stuck_quality)
      for (Index c : star_)
        for (Index u : mesh_.at(c))
          longest = std::max(longest, fast_length(mesh_.vertex(v), mesh_.vertex(u)));
    return longest;
  }

  void move(Index v) {
    if (!trial_.gather(v, star_))
      return;
    const Vertex<3> &here = mesh_.vertex(v);
    const Matrix<3> L = lower_factor<3>(here.M);
    const double worst = trial_.least_before();
    const Vector<3> ideal = ideal_step(
        volume_, v, star_, [&](const Vector<3> &step) { return in_metric(L, step); },
        smallest_facet);
    if (ideal.squaredNorm() < smallest_step * smallest_step && worst > good_quality)
      return;
    for (const double fraction : step_fractions)
      if (try_move(v, here.x + in_space(L, fraction * ideal)))
        return;
    if (worst > random_below)
      return;
    CounterRandom random(run_.seed, Stream::relocate, v, volume_.clock);
    (void)try_move(v, here.x + in_space(L, random_radius * random_in_ball(random)));
  }

  /// Moves v, the vertex of the trial, there when that makes its star better.
  [[nodiscard]] bool try_move(Index v, const Vector<3> &x) {
    trial_.place(x);
    if (!trial_.is_positive())
      return false;
    trial_.take_metric();
    const StarShapes &shapes = trial_.measure();
    const double worst = trial_.least_before(), least = shapes.minimum();
    if (least < std::min(worst, move_floor) - round_off || least <= 0)
      return false;
    const double n = static_cast<double>(shapes.size());
    const double sum = trial_.sum_before(), total = shapes.sum();
    const RequiredGain &gain = volume_.is_at_rest(v) ? clear_gain : any_gain;
    const bool is_better =
        (least > better_by(gain.worst, worst) && total > sum - gain.mean_loss * n) ||
        total > sum + gain.mean * n;
    if (!is_better || !trial_.keeps_surfaces())
      return false;
    trial_.commit();
    ++counts.moves;
    return true;
  }

  /// Replaces the star of v by its metric-Delaunay star.
  void reinsert(Index v) {
    const std::size_t n_star = star_.size();
    grow_cavity(volume_, v, star_);
    if (volume_.is_put_off || star_.size() == n_star)
      return;
    const Acceptance acceptance{.floor =
                                    std::min(rule_.reinsertion_floor, worst_of_star()),
                                .gain = 0,
                                .longest = longest_reinserted,
                                .is_apex_in_place = true};
    if (operator_.replace(star_, v, {none, none}, acceptance))
      ++counts.insertions;
  }
};

} // namespace

void improve_vertices(Volume &volume, const Run &run, PassLog &log,
                      const VertexRule &rule) {
  const std::uint32_t since = log.begin(Pass::vertex, volume);
  const Triangulation<3> &mesh = volume.mesh;
  std::vector<Index> all;
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k)
    if (mesh.is_used(static_cast<Index>(k)) &&
        mesh.feature[k] != Triangulation<3>::corner)
      all.push_back(static_cast<Index>(k));
  PerVertex<std::uint8_t> is_placed(mesh.vertices.size(), 0);
  SlabTeam<VertexImprovement> team(volume, run, [&](Volume &view) {
    return VertexImprovement(view, run, rule, since, is_placed);
  });
  log.counts += team.visit(std::move(all), [&](Index v, int round) {
    // the graph of ridges is no slab's
    return volume.feature(v) <= 1 ? Slabs::nowhere
                                  : volume.state.slabs.of_star(v, round);
  });
}

} // namespace anistar
