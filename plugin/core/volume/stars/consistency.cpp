#include "volume/stars/consistency.h"

#include "stars/algorithm_2.h"
#include "stars/certify_all.h"
#include "surface/facet_bulges.h"
#include "volume/mesh/shell.h"
#include "volume/mesh/surface_arrays.h"
#include "volume/stars/agreement.h"
#include "volume/stars/far_violations.h"
#include "volume/stars/star_mending.h"
#include "volume/stars/vertex_mover.h"

#include <utility>

namespace anistar {
namespace {

/// Rounds without fewer failing cells after which the run has stalled.
constexpr int usual_patience = 16, patience_with_last = 64;
/// So many failing cells are the last ones: all facets may be in order then, and only
/// the certificate shows which moves help. Rounds cost little.
constexpr std::size_t last_failing = 20;
/// While a round leaves less than this part of the failing cells, vertices are moved
/// wherever the cost goes down; then only where fewer facets fail, and points come in.
constexpr double good_progress = .95;
/// A round that leaves more than this part of them brings nothing.
constexpr double any_progress = .995;
/// Vertices are not moved while more cells fail than this part: it would help little
/// for what it costs. More places are tried only when at most so many cells fail.
constexpr double many_failing = .3;
constexpr std::size_t few_failing = 100;
/// Rounds without a gain after which a run with few failing cells is stuck. It tries
/// more places, and allows an insertion one more failing facet after every so many
/// rounds: usually it must leave fewer.
constexpr int stuck_after = 3, usual_trials = 3, more_trials = 10;
constexpr int fewer_failing = -1, most_allowed = 2, rounds_per_facet = 4;
/// While at most this part of the cells fails, what the rules hardly improve goes
/// through agreement and mending again, that many rounds later at the earliest:
/// they swap facets of surfaces, remove vertices and let them wander, which the rules
/// do not, and a facet costs them far less than a cavity. With more patience than the
/// first time.
constexpr double agreeable = .05;
constexpr int agreement_period = 5;
constexpr AgreementEffort patient_effort{full_effort.trials_per_cell,
                                         full_effort.mended_part, 5};
/// The clock is looked at after so many bad cells.
constexpr std::size_t cells_between_looks = 32;
/// New vertices keep this distance from the others in their own metric (packing).
constexpr double separation = .4;
/// Edges of encroached facets that are shorter than this are not split.
constexpr double shortest_split = .8;
/// Points of an edge that are tried, within this part of it about its middle.
constexpr int edge_candidates = 5;
constexpr double edge_part = .3;

/// How hard a round tries.
struct Effort {
  bool moves;         ///< vertices
  bool inserts_early; ///< before vertices are moved without fewer failing facets
  bool is_stuck;      ///< walls that cannot be split are no obstacle any more
  int trials;         ///< places for a vertex at each distance
  int allowance;      ///< a point may make so many more facets fail
};

/// How the failing cells became fewer.
struct Progress {
  double failing = 1;                     ///< part of the cells
  double before = 1;                      ///< in the round before
  double reference = 1;                   ///< when the count below was reset
  int since_best = 0;                     ///< rounds that brought nothing
  int since_agreement = agreement_period; ///< rounds

  void note(double now) {
    before = std::exchange(failing, now);
    ++since_best;
    ++since_agreement;
    if (failing < any_progress * reference) {
      reference = failing;
      since_best = 0;
    }
  }
  [[nodiscard]] bool asks_for_agreement() const {
    return failing <= agreeable && failing > good_progress * before &&
           since_agreement >= agreement_period;
  }
  [[nodiscard]] Effort effort(std::size_t n_bad) const {
    const bool is_stuck = since_best > stuck_after && n_bad <= few_failing;
    const int patience_spent = since_best / rounds_per_facet;
    return {
        .moves = failing<many_failing, .inserts_early = failing> good_progress * before,
        .is_stuck = is_stuck,
        .trials = is_stuck ? more_trials : usual_trials,
        .allowance = is_stuck ? std::min(fewer_failing + patience_spent, most_allowed)
                              : fewer_failing};
  }
};

/// The rounds of Algorithm 2, and the judge of Pick_valid.
class Rounds {
public:
  static constexpr std::size_t d = 3;
  static constexpr int max_rounds = 200;
  using Score = PointScore;

  /// What a run must be able to return to.
  using Snapshot = VolumeMesh;

  Rounds(Volume &volume, const Run &run, const RemeshSettings &settings,
         const DelaunayBits &known)
      : volume_(volume), mesh_(volume.mesh), run_(run),
        parameters_(settings.parameters), shape_(settings.shape),
        normals_(volume, run.threads), operator_(volume), insertion_(volume, normals_),
        mover_(volume, insertion_, operator_, settings.parameters.sigma_0) {
    shape_.frozen_tags.clear(); // which the certificate does not know

    progress_.failing = progress_.reference = failing_fraction(mesh_, known.bits);
  }

  [[nodiscard]] const Triangulation<3> &mesh() const { return mesh_; }
  [[nodiscard]] const Background<3> &background() const { return volume_.background; }
  [[nodiscard]] std::size_t n_vertices() const { return volume_.n_vertices(); }
  [[nodiscard]] SurfaceStars<3> surface_stars(double done) {
    normals_ = SurfaceNormals(volume_, run_.threads);
    SurfaceStars<3> stars{facets_as_certified(), {}};
    stars.inside = encroaching_vertices<3>(certified(mesh_), stars.facets, run_.threads,
                                           to_the_end(run_.monitor, done));
    return stars;
  }
  [[nodiscard]] int patience(std::size_t n_bad) const {
    return n_bad <= last_failing ? patience_with_last : usual_patience;
  }
  [[nodiscard]] bool are_rules_everywhere() const { return false; }
  [[nodiscard]] bool is_starting() const { return false; }
  [[nodiscard]] int rounds_without_gain() const { return progress_.since_best; }
  [[nodiscard]] Snapshot snapshot() const { return volume_.state; }
  void restore(Snapshot &&from) { volume_.state = std::move(from); }
  void note(double failing, double) { progress_.note(failing); }

  void treat(const std::vector<BadCell<3>> &bad, ConsistencyCounts &counts,
             DelaunayBits &known) {
    const Run run = run_.in_round(counts.rounds + 1);
    const std::uint32_t since = ++volume_.clock;
    const bool agreeing = progress_.asks_for_agreement();
    if (agreeing) {
      progress_.since_agreement = 0;
      counts.moves += agree(volume_, run, patient_effort).moves;
    } else {
      change_all(bad, counts);
    }
    renew(since, fraction_of(counts), known);
    if (agreeing || bad.size() <= last_failing)
      counts.moves += mend_stars(volume_, run, full_effort, known).moves;
  }

  [[nodiscard]] bool starts_at_centre(Rule) const { return true; }
  [[nodiscard]] bool is_enough(Rule, const Picked<3, PointScore> &) const {
    return false;
  }
  [[nodiscard]] Judgement<PointScore> judge(const Vertex<3> &p, Index cell,
                                            double radius) {
    if (!insertion_.gather(p, std::array{cell}, {.closest = separation}))
      return {};
    const HalfFacet wall = insertion_.encroached();
    if (wall.exists() && !effort_.is_stuck)
      return {{}, wall};
    return {insertion_.score(parameters_.sigma_0, radius), wall};
  }

private:
  Volume &volume_;
  Triangulation<3> &mesh_;
  const Run &run_;
  const ConsistencyParameters &parameters_;
  DomainShape shape_;
  SurfaceNormals normals_;
  CavityOperator operator_;
  VolumeInsertion insertion_;
  VertexMover mover_;
  Progress progress_;
  std::vector<std::uint8_t> touched_; ///< vertices where this round has made a change
  Effort effort_{};
  Shell shell_;

  [[nodiscard]] static double fraction_of(const ConsistencyCounts &counts) {
    return static_cast<double>(counts.rounds) / max_rounds;
  }

  [[nodiscard]] std::vector<SeenFacet<3>> facets_as_certified() const {
    const SurfaceArrays surface =
        surface_arrays(mesh_, volume_.ridges.edges(), volume_.surface);
    std::vector<Vector<3>> points;
    points.reserve(mesh_.vertices.size());
    for (const Vertex<3> &vertex : mesh_.vertices)
      points.push_back(vertex.x);
    const std::vector<FacetBulge<3>> bulges = facet_bulges({points,
                                                            surface.facets,
                                                            surface.facet_tags,
                                                            surface.edges,
                                                            surface.edge_tags,
                                                            {},
                                                            shape_});
    std::vector<SeenFacet<3>> seen;
    seen.reserve(surface.facets.size());
    for (std::size_t f = 0; f < surface.facets.size(); ++f)
      seen.push_back(seen_facet<3>(certified(mesh_), surface.sides[f],
                                   surface.facets[f], bulges[f]));
    return seen;
  }

  /// One change for each bad cell that shares no vertex with one treated before.
  void change_all(const std::vector<BadCell<3>> &bad, ConsistencyCounts &counts) {
    touched_.assign(mesh_.vertices.size(), 0);
    effort_ = progress_.effort(bad.size());
    const double fraction = fraction_of(counts);
    for (std::size_t k = 0; k < bad.size(); ++k) {
      const BadCell<3> &item = bad[k];
      if (!run_.monitor.keep_going(volume_.n_vertices(), fraction) ||
          (k % cells_between_looks == 0 && !run_.monitor.look(fraction)))
        return;
      if (mesh_.at(item.cell) == item.vertices &&
          std::none_of(item.vertices.begin(), item.vertices.end(),
                       [&](Index v) { return is_touched(v); }))
        change(item, counts);
    }
  }

  /// Decides again where the mesh has changed since the clock showed `since`: all of
  /// it, or the bits would be those of another mesh.
  void renew(std::uint32_t since, double fraction, DelaunayBits &known) {
    std::vector<Index> changed;
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
      if (mesh_.is_alive(static_cast<Index>(c)) && volume_.cell_clock[c] >= since)
        changed.push_back(static_cast<Index>(c));
    renew_bits<3>(certified(mesh_), changed, run_.threads,
                  to_the_end(run_.monitor, fraction), known);
  }

  [[nodiscard]] bool is_touched(Index v) const {
    return std::cmp_greater_equal(v, touched_.size()) || touched_[v] != 0;
  }
  void touch_link() {
    touched_.resize(mesh_.vertices.size(), 1);
    for (Index v : insertion_.link())
      touched_[v] = 1;
  }

  void change(const BadCell<3> &item, ConsistencyCounts &counts) {
    const auto insert = [&] {
      return item.is_facet() ? insert_in(item, counts)
                             : insert_or_snap_valid(item, counts);
    };
    if (!effort_.moves) {
      (void)insert();
    } else if (!effort_.inserts_early) {
      if (!move_any(item, counts, 0))
        (void)insert();
    } else if (!move_any(item, counts, fewer_failing) && !insert()) {
      (void)move_any(item, counts, 0);
    }
  }

  /// Moves one of the vertices of a bad cell, or of those across its facets.
  bool move_any(const BadCell<3> &item, ConsistencyCounts &counts, int most_failing) {
    std::array<Index, 8> vertices;
    std::size_t n = 0;
    for (Index v : item.vertices)
      vertices[n++] = v;
    for (std::size_t i = 0; i < 4; ++i)
      if (const HalfFacet beyond = mesh_.opposite(HalfFacet(item.cell, i));
          beyond.exists() && !is_touched(mesh_.apex(beyond)))
        vertices[n++] = mesh_.apex(beyond);
    for (std::size_t k = 0; k < n; ++k) {
      const Index v = vertices[k];
      CounterRandom random(run_.seed, Stream::reenter, v, counts.rounds);
      if (mover_.move(v, {.trials = effort_.trials, .most_failing = most_failing},
                      random)) {
        ++counts.moves;
        touched_[v] = 1;
        touch_link();
        return true;
      }
    }
    return false;
  }

  /// A point of the surface for a bad facet, on one of its edges.
  bool insert_in(const BadCell<3> &item, ConsistencyCounts &counts) {
    if (!run_.monitor.has_room(volume_.n_vertices()) || !split(item.facet))
      return false;
    counts.add(item.rule);
    return true;
  }

  /// Insert_or_snap_valid (Algorithm 5): Pick_valid (Algorithm 3) and Insert (Algorithm
  /// 1), or a point of the wall that the picked one encroaches upon.
  bool insert_or_snap_valid(const BadCell<3> &item, ConsistencyCounts &counts) {
    if (!run_.monitor.has_room(volume_.n_vertices()))
      return false;
    const CounterRandom random(run_.seed, Stream::pick, item.cell, counts.rounds);
    const auto [best, wall] =
        pick_valid<3>(mesh_, volume_.background, item, parameters_, random, *this);
    if (!best.exists() || effort_.is_stuck)
      if (wall.exists() && split(wall)) {
        ++counts.boundary;
        return true;
      }
    if (!best.exists() || best.score.failing > effort_.allowance ||
        !insertion_.gather(best.p, std::array{best.seed}, {.closest = separation}))
      return false;
    const Index v =
        volume_.add_vertex(best.p, Triangulation<3>::interior, none, best.background);
    if (!enter(v, {none, none}))
      return false;
    counts.add(item.rule);
    return true;
  }

  /// Replaces the cavity that was gathered by the star of a new vertex.
  bool enter(Index v, std::array<Index, 2> lost) {
    if (!operator_.replace(insertion_.cells(), v, lost, {quality_floor})) {
      volume_.remove_vertex(v);
      return false;
    }
    touch_link();
    return true;
  }

  /// Splits the longest edge of a wall, at the best of some of its points.
  bool split(HalfFacet wall) {
    const Facet<3> t = mesh_.facet(wall);
    Index a = none, b = none;
    double longest = shortest_split;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index u = t[k], w = t[(k + 1) % 3];
      if (const double l = fast_length(mesh_.vertex(u), mesh_.vertex(w)); l > longest) {
        longest = l;
        a = u;
        b = w;
      }
    }
    if (a == none || !shell_of(mesh_, wall.cell(), a, b, shell_))
      return false;
    const EdgeFeature feature = feature_of(volume_, shell_);
    if (feature.is_frozen)
      return false;
    const ScoredPlace best = best_on_edge(feature);
    if (!best.exists() || best.score.failing > effort_.allowance ||
        !insertion_.gather(best.p, shell_.all(),
                           {.closest = separation, .lost = {a, b}}))
      return false;
    const Index v =
        volume_.add_vertex(best.p, feature.dimension, feature.lies_on, best.background);
    if (!enter(v, {a, b}))
      return false;
    if (feature.ridge != none)
      volume_.ridges.split(a, b, v);
    return true;
  }

  [[nodiscard]] ScoredPlace best_on_edge(const EdgeFeature &feature) {
    const Vector<3> &a = mesh_.vertex(shell_.a).x, &b = mesh_.vertex(shell_.b).x;
    ScoredPlace best;
    for (int k = 0; k < edge_candidates; ++k) {
      const double s = .5 + edge_part * (double(k) / (edge_candidates - 1) - .5);
      ScoredPlace found{{}, {}, shell_.cells[0], mesh_.background_cell[shell_.a]};
      found.p = volume_.background.vertex(
          volume_.surface.place(feature.dimension, feature.lies_on, a + s * (b - a)),
          found.background);
      if (!insertion_.gather(found.p, shell_.all(),
                             {.closest = separation, .lost = {shell_.a, shell_.b}}))
        continue;
      found.score = insertion_.score(parameters_.sigma_0,
                                     std::numeric_limits<double>::infinity());
      if (found.score.is_better(best.score))
        best = found;
    }
    return best;
  }
};

} // namespace

ConsistencyCounts refine_until_consistent(Volume &volume, const Run &run,
                                          const RemeshSettings &settings,
                                          DelaunayBits &known) {
  Rounds rounds(volume, run, settings, known);
  return insert_until_consistent(rounds, run, settings.parameters, known);
}

} // namespace anistar
