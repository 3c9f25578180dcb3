#include "plane/stars/consistency.h"

#include "plane/stars/agreement.h"
#include "plane/stars/insertion.h"
#include "plane/stars/seen_curves.h"
#include "plane/stars/star_mending.h"
#include "stars/algorithm_2.h"
#include "stars/certify_all.h"

namespace anistar {
namespace {

/// Rounds without fewer failing cells after which the run has stalled.
constexpr int patience_of_rounds = 12;
/// Vertices are moved after every round when few cells fail, now and then when more do,
/// and never when nearly all do: that would help little for what it costs.
constexpr double few_failing = .02, many_failing = .3;
constexpr int rounds_between_moves = 4;
/// Encroached edges shorter than this are not split.
constexpr double shortest_split = .8;

[[nodiscard]] bool is_moved_after(int round, double failing) {
  return failing < few_failing ||
         (failing < many_failing &&
          round % rounds_between_moves == rounds_between_moves - 1);
}

/// The rounds of Algorithm 2, and the judge of Pick_valid.
class Rounds {
public:
  static constexpr std::size_t d = 2;
  static constexpr int max_rounds = 160;
  using Snapshot = MeshOnCurves;
  using Score = Hits;

  Rounds(Workspace &w, const Run &run, const ConsistencyParameters &parameters,
         bool relocate)
      : w_(w), mesh_(w.mesh), run_(run), parameters_(parameters), relocates_(relocate),
        is_starting_(!relocate), insertion_(w) {}

  [[nodiscard]] const Triangulation<2> &mesh() const { return mesh_; }
  [[nodiscard]] const Background<2> &background() const { return w_.background; }
  [[nodiscard]] std::size_t n_vertices() const { return mesh_.vertices.size(); }
  [[nodiscard]] SurfaceStars<2> surface_stars(double done) const {
    SurfaceStars<2> stars{seen_curves(w_), {}};
    stars.inside = encroaching_vertices<2>(certified(mesh_), stars.facets, run_.threads,
                                           to_the_end(run_.monitor, done));
    return stars;
  }
  [[nodiscard]] int patience(std::size_t) const { return patience_of_rounds; }
  [[nodiscard]] bool are_rules_everywhere() const { return !relocates_; }
  [[nodiscard]] bool is_starting() const { return is_starting_; }
  [[nodiscard]] int rounds_without_gain() const { return since_best_; }
  [[nodiscard]] Snapshot snapshot() const { return w_.on_curves; }
  void restore(Snapshot &&from) { w_.on_curves = std::move(from); }

  void treat(const std::vector<BadCell<2>> &bad, ConsistencyCounts &counts,
             DelaunayBits &known) {
    const bool moving =
        relocates_ &&
        is_moved_after(counts.rounds, failing_fraction(mesh_, known.bits));
    const Rule rule = insert_for_all(bad, counts);
    // in the pure mode the other rules end by packing, and only consistency can stall
    since_best_ += relocates_ || rule == Rule::facet_inconsistency ||
                   rule == Rule::inconsistency || rule == Rule::kept;
    is_starting_ = is_starting_ && is_about_size(rule);
    const Run run = run_.in_round(counts.rounds + 1);
    if (moving)
      (void)agree(w_, run);
    renumber(w_, run.threads);
    known = certify_all(mesh_, run);
    if (moving)
      mend_stars(w_, run, known);
  }
  void note(double failing, double best) {
    if (is_starting_ || failing < best)
      since_best_ = 0;
  }

  /// Rule 1 inserts the circumcentre itself, the others a point of the picking region.
  [[nodiscard]] bool starts_at_centre(Rule rule) const { return rule == Rule::size; }
  [[nodiscard]] bool is_enough(Rule rule, const Picked<2, Hits> &picked) const {
    if (rule == Rule::size && picked.wall.exists())
      return true;
    return picked.best.exists() && (rule == Rule::size || picked.best.score.n == 0);
  }
  [[nodiscard]] Judgement<Hits> judge(const Vertex<2> &p, Index cell, double radius) {
    if (const HalfFacet wall = insertion_.encroached(p, cell); wall.exists())
      return {{}, wall};
    if (!insertion_.gather(p, cell))
      return {};
    return {insertion_.score(p, radius), {}};
  }

private:
  Workspace &w_;
  Triangulation<2> &mesh_;
  const Run &run_;
  const ConsistencyParameters &parameters_;
  bool relocates_, is_starting_;
  Insertion insertion_;
  int since_best_ = 0; ///< rounds that brought nothing

  /// One point for each bad cell that shares no vertex with one treated before, of the
  /// first rule that can place any. @returns that rule, `kept` when no rule can.
  Rule insert_for_all(const std::vector<BadCell<2>> &bad, ConsistencyCounts &counts) {
    std::vector<bool> touched(mesh_.vertices.size(), false);
    const std::size_t before = mesh_.vertices.size();
    Rule acting = Rule::kept;
    for (const BadCell<2> &item : bad) {
      if (item.rule != acting && mesh_.vertices.size() > before)
        break;
      acting = item.rule;
      if (mesh_.at(item.cell) != item.vertices ||
          std::any_of(item.vertices.begin(), item.vertices.end(),
                      [&](Index v) { return touched[v]; }))
        continue;
      for (Index v : item.vertices)
        touched[v] = true;
      insert_for(item, counts);
    }
    return mesh_.vertices.size() > before ? acting : Rule::kept;
  }

  void insert_for(const BadCell<2> &item, ConsistencyCounts &counts) {
    if (item.is_facet())
      insert_in(item, counts);
    else
      insert_or_snap_valid(item, counts);
  }

  /// A point of the picking region of an edge: the middle of its curve.
  void insert_in(const BadCell<2> &item, ConsistencyCounts &counts) {
    if (split_edge(w_, item.facet) != none)
      counts.add(item.rule);
  }

  /// Algorithm 5: a point that encroaches upon a wall becomes a point on the wall.
  void insert_or_snap_valid(const BadCell<2> &item, ConsistencyCounts &counts) {
    const CounterRandom random(run_.seed, Stream::pick, item.cell, counts.rounds);
    const auto [best, wall] =
        pick_valid<2>(mesh_, w_.background, item, parameters_, random, *this);
    if (best.exists()) {
      if (insertion_.gather(best.p, best.seed)) {
        insertion_.enter(best.p, best.background);
        counts.add(item.rule);
      }
    } else if (wall.exists() && w_.length(wall) > shortest_split &&
               split_edge(w_, wall) != none) {
      ++counts.boundary;
    }
  }
};

} // namespace

ConsistencyCounts refine_until_consistent(Workspace &w, const Run &run,
                                          const ConsistencyParameters &parameters,
                                          bool relocate, DelaunayBits &known) {
  Rounds rounds(w, run, parameters, relocate);
  return insert_until_consistent(rounds, run, parameters, known);
}

} // namespace anistar
