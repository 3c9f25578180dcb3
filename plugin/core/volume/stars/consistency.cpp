#include "volume/stars/consistency.h"

#include "base/ellipse_sampler.h"
#include "mesh/mesh_walk.h"
#include "stars/bad_cells.h"
#include "stars/algorithm_2.h"
#include "volume/mesh/shell.h"
#include "volume/stars/agreement.h"
#include "volume/stars/star_mending.h"
#include "volume/stars/vertex_mover.h"

#include <optional>
#include <utility>

namespace anistar {
namespace {

constexpr int max_rounds = 200;
/// Rounds without fewer failing cells after which the run has stalled.
constexpr int patience = 16, patience_with_last = 64;
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
/// While at most this part of the cells fails, what the rules hardly improve goes
/// through agreement and the star check again, that many rounds later at the earliest:
/// they swap facets of surfaces, remove vertices and let them wander, which the rules
/// do not, and a facet costs them far less than a cavity. With more patience than the
/// first time.
constexpr double agreeable = .05;
constexpr int agreement_period = 5, agreement_persistence = 5;
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
  double failing;                         ///< part of the cells
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
    const bool is_stuck = since_best > 3 && n_bad <= few_failing;
    return {failing<many_failing, failing> good_progress * before, is_stuck,
            is_stuck ? 10 : 3, is_stuck ? std::min(-1 + since_best / 4, 2) : -1};
  }
};

class Rounds {
public:
  Rounds(Volume &volume, Monitor &monitor, const ConsistencyParameters &parameters,
         Seed seed, ConsistencyCounts &counts)
      : volume_(volume), mesh_(volume.mesh), monitor_(monitor), parameters_(parameters),
        seed_(seed), operator_(volume), insertion_(volume),
        mover_(volume, insertion_, operator_, parameters.sigma_0), counts_(counts) {}

  /// One change for each bad cell that shares no vertex with one treated before.
  void treat(const std::vector<BadCell<3>> &bad, int round, const Effort &effort) {
    touched_.assign(mesh_.vertices.size(), 0);
    effort_ = effort;
    for (std::size_t k = 0; k < bad.size(); ++k) {
      const BadCell<3> &item = bad[k];
      const double fraction = static_cast<double>(round) / max_rounds;
      if (!monitor_.keep_going(volume_.n_vertices(), fraction) ||
          (k % cells_between_looks == 0 && !monitor_.look(fraction)))
        return;
      if (mesh_.at(item.cell) == item.vertices &&
          std::none_of(item.vertices.begin(), item.vertices.end(),
                       [&](Index v) { return is_touched(v); }))
        treat(item, round);
    }
  }

private:
  Volume &volume_;
  Triangulation<3> &mesh_;
  Monitor &monitor_;
  const ConsistencyParameters &parameters_;
  Seed seed_;
  CavityOperator operator_;
  VolumeInsertion insertion_;
  VertexMover mover_;
  ConsistencyCounts &counts_;
  std::vector<std::uint8_t> touched_; ///< vertices where this round has made a change
  Effort effort_{};
  Shell shell_;

  [[nodiscard]] bool is_touched(Index v) const {
    const std::size_t i = v;
    return i >= touched_.size() || touched_[i] != 0;
  }
  void touch_link() {
    touched_.resize(mesh_.vertices.size(), 1);
    for (Index v : insertion_.link())
      touched_[v] = 1;
  }

  void treat(const BadCell<3> &item, int round) {
    if (!effort_.moves) {
      (void)insert_for(item, round);
    } else if (!effort_.inserts_early) {
      if (!move_any(item, round, 0))
        (void)insert_for(item, round);
    } else if (!move_any(item, round, -1) && !insert_for(item, round)) {
      (void)move_any(item, round, 0);
    }
  }

  /// Moves one of the vertices of a bad cell, or of those across its facets.
  bool move_any(const BadCell<3> &item, int round, int most_failing) {
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
      CounterRandom random(seed_, Stream::make_way, v, round);
      if (mover_.move(v, {effort_.trials, most_failing}, random)) {
        ++counts_.moves;
        touched_[v] = 1;
        touch_link();
        return true;
      }
    }
    return false;
  }

  /// Pick_valid (Algorithm 3) and Insert (Algorithm 1), or the split of a wall that the
  /// point encroaches upon.
  bool insert_for(const BadCell<3> &item, int round) {
    if (!monitor_.has_room(volume_.n_vertices()))
      return false;
    HalfFacet wall;
    const ScoredPoint best = pick_valid(item, round, wall);
    if (best.seed == none || effort_.is_stuck)
      if (wall.exists() && split(wall))
        return true;
    if (best.seed == none || best.score.failing > effort_.allowance ||
        !insertion_.gather(best.p, std::array{best.seed}, {separation}))
      return false;
    const Index v =
        volume_.add_vertex(best.p, Triangulation<3>::interior, none, best.background);
    if (!enter(v, {none, none}))
      return false;
    counts_.add(item.rule);
    return true;
  }

  /// The best of the circumcentre and random points of the picking region.
  /// @param wall a constrained facet that one of them encroaches upon
  [[nodiscard]] ScoredPoint pick_valid(const BadCell<3> &item, int round,
                                       HalfFacet &wall) {
    const SymmetricTensor<3> M = mesh_.vertex(item.star).M;
    const Circumsphere<3> ball = circumsphere<3>(M, mesh_.simplex(item.cell));
    const EllipseSampler<3> ellipse(M);
    CounterRandom random(seed_, Stream::pick, item.cell, round);
    ScoredPoint best;
    for (int k = 0; k < parameters_.candidates; ++k) {
      Vector<3> x = ball.centre;
      if (k > 0)
        x += ellipse.step(parameters_.delta * ball.radius, random);
      const Walk at = walk_to(mesh_, item.cell, x);
      if (at.wall.exists())
        wall = at.wall;
      if (at.cell == none)
        continue;
      ScoredPoint found{{}, {}, at.cell, mesh_.background_cell[item.star]};
      found.p = volume_.background.vertex(x, found.background);
      if (!insertion_.gather(found.p, std::array{at.cell}, {separation}))
        continue;
      if (const HalfFacet near = insertion_.encroached(); near.exists()) {
        wall = near;
        if (!effort_.is_stuck)
          continue;
      }
      found.score =
          insertion_.score(parameters_.sigma_0, parameters_.beta * ball.radius);
      if (found.score.is_better(best.score))
        best = found;
    }
    return best;
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
    const ScoredPoint best = best_on_edge(feature);
    if (best.seed == none || best.score.failing > effort_.allowance ||
        !insertion_.gather(best.p, shell_.all(), {separation, {a, b}}))
      return false;
    const Index v =
        volume_.add_vertex(best.p, feature.dimension, feature.lies_on, best.background);
    if (!enter(v, {a, b}))
      return false;
    if (feature.ridge != none)
      volume_.ridges.split(a, b, v);
    ++counts_.boundary;
    return true;
  }

  [[nodiscard]] ScoredPoint best_on_edge(const EdgeFeature &feature) {
    const Vector<3> &a = mesh_.vertex(shell_.a).x, &b = mesh_.vertex(shell_.b).x;
    ScoredPoint best;
    for (int k = 0; k < edge_candidates; ++k) {
      const double s = .5 + edge_part * (double(k) / (edge_candidates - 1) - .5);
      ScoredPoint found{{}, {}, shell_.cells[0], mesh_.background_cell[shell_.a]};
      found.p = volume_.background.vertex(
          volume_.surface.place(feature.dimension, feature.lies_on, a + s * (b - a)),
          found.background);
      if (!insertion_.gather(found.p, shell_.all(), {separation, {shell_.a, shell_.b}}))
        continue;
      found.score = insertion_.score(parameters_.sigma_0,
                                     std::numeric_limits<double>::infinity());
      if (found.score.is_better(best.score))
        best = found;
    }
    return best;
  }
};

[[nodiscard]] double failing_fraction(const Triangulation<3> &mesh,
                                      const std::vector<std::uint8_t> &bits) {
  return 1 - certified_fractions(mesh, bits).simplex_ok;
}

/// What a run must be able to return to.
struct Snapshot {
  Snapshot(const Volume &volume, const DelaunayBits &bits, double fraction)
      : state(*volume.data), free_vertices(volume.free_vertices), known(bits),
        failing(fraction) {}

  VolumeState state;
  std::vector<Index> free_vertices;
  DelaunayBits known;
  double failing;
};

void restore(Volume &volume, Snapshot &&from) {
  static_cast<VolumeState &>(*volume.data) = std::move(from.state);
  volume.free_vertices = std::move(from.free_vertices);
}

/// Decides again where the mesh has changed since the clock showed `since`.
void renew(const Volume &volume, std::uint32_t since, int threads, const Look &look,
           DelaunayBits &known) {
  const Triangulation<3> &mesh = volume.mesh;
  known.bits.resize(mesh.cells.size(), 0);
  known.reach.resize(mesh.cells.size(), 0);
  std::vector<Index> changed;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    if (mesh.is_alive(static_cast<Index>(c)) && volume.cell_clock[c] >= since)
      changed.push_back(static_cast<Index>(c));
  renew_bits<3>(certified(mesh),
                dependent_cells<3>(mesh.neighbours, changed, known.reach), threads,
                look, known);
}

} // namespace

ConsistencyCounts refine_until_consistent(Volume &volume, Monitor &monitor,
                                          const ConsistencyParameters &parameters,
                                          double hausdorff_number, Seed seed,
                                          int threads, DelaunayBits &known) {
  ConsistencyCounts counts;
  Rounds rounds(volume, monitor, parameters, seed, counts);
  RoundBounds bounds{max_rounds, patience,
                     (1 + parameters.max_growth) *
                         static_cast<double>(volume.n_vertices())};
  Progress progress{failing_fraction(volume.mesh, known.bits)};
  progress.reference = progress.failing;
  std::optional<Snapshot> best(std::in_place, volume, known, progress.failing);
  for (counts.rounds = 0;; ++counts.rounds) {
    const std::vector<BadCell<3>> bad =
        bad_cells<3>(volume.mesh, volume.background, known.bits, parameters, false);
    const bool are_last = bad.size() <= last_failing;
    bounds.patience = are_last ? patience_with_last : patience;
    counts.stop = bounds.stop(bad.empty(), counts.rounds, progress.since_best,
                              volume.n_vertices(), monitor);
    if (!counts.stop.empty())
      break;
    const std::uint32_t since = ++volume.clock;
    const Seed round_seed{seed.value, static_cast<std::uint32_t>(counts.rounds) + 1};
    const bool agreeing = progress.asks_for_agreement();
    if (agreeing) {
      progress.since_agreement = 0;
      counts.moves += agree_volume(volume, monitor, hausdorff_number, round_seed,
                                   threads, agreement_persistence)
                          .moves;
    } else {
      rounds.treat(bad, counts.rounds, progress.effort(bad.size()));
    }
    // all of it, or the bits would be those of another mesh
    renew(
        volume, since, threads,
        [&](double) {
          (void)monitor.look(double(counts.rounds) / max_rounds);
          return true;
        },
        known);
    if (agreeing || are_last)
      counts.moves += mend_stars(volume, monitor, hausdorff_number, round_seed, known);
    progress.note(failing_fraction(volume.mesh, known.bits));
    if (progress.failing < best->failing)
      best.emplace(volume, known, progress.failing);
  }
  if (progress.failing > best->failing) {
    known = std::move(best->known);
    restore(volume, std::move(*best));
  }
  counts.ln_gamma_p90 = ln_gamma_p90(volume.mesh, known.bits);
  return counts;
}

} // namespace anistar
