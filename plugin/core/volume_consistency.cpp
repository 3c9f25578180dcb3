#include "volume_consistency.h"

#include "bounded_distortion.h"
#include "ellipse_sampler.h"
#include "volume_insertion.h"

#include <optional>

namespace anistar {
namespace {

constexpr int max_rounds = 80;
/// Rounds without fewer failing cells after which the run has stalled.
constexpr int patience = 12;
/// A point may make so many more facets disagree: none at first, then one more with
/// every round that brings nothing.
constexpr int first_allowance = -1, last_allowance = 2;
/// Of the new cells; below it they must be better than the worst that they replace.
constexpr double quality_floor = .3;
/// Edges of encroached facets that are shorter than this are not split.
constexpr double shortest_split = .8;
/// Points of an edge that are tried, within this part of it about its middle.
constexpr int edge_candidates = 5;
constexpr double edge_part = .3;

/// What a point is inserted by.
struct Pick {
  PointScore score;
  Vertex<3> p{};
  Index cell = none, background = none;
};

class Rounds {
public:
  Rounds(Volume &volume, Monitor &monitor, const ConsistencyParameters &parameters,
         std::uint64_t seed, ConsistencyCounts &counts)
      : volume_(volume), mesh_(volume.mesh), monitor_(monitor), parameters_(parameters),
        seed_(seed), operator_(volume), insertion_(volume), counts_(counts) {}

  [[nodiscard]] std::vector<BadCell<3>>
  bad_cells(const std::vector<std::uint8_t> &bits) const {
    return anistar::bad_cells(
        mesh_, bits, parameters_, false, [&](const Circumsphere<3> &ball, Index v) {
          return distortion_size(volume_.background, ball,
                                 mesh_.background_cell[static_cast<std::size_t>(v)],
                                 parameters_.gamma_0);
        });
  }

  /// One point for each bad cell that shares no vertex with one treated before.
  /// @returns how many were inserted.
  std::size_t treat(const std::vector<BadCell<3>> &bad, int round, int allowance) {
    touched_.assign(mesh_.vertices.size(), 0);
    allowance_ = allowance;
    std::size_t n = 0;
    for (std::size_t k = 0; k < bad.size(); ++k) {
      const BadCell<3> &item = bad[k];
      if (!monitor_.keep_going(volume_.n_vertices(),
                               static_cast<double>(round) / max_rounds))
        break;
      if (mesh_.at(item.cell) != item.vertices ||
          std::any_of(item.vertices.begin(), item.vertices.end(),
                      [&](Index v) { return is_touched(v); }))
        continue;
      n += insert_for(item, round);
    }
    return n;
  }

private:
  Volume &volume_;
  Triangulation<3> &mesh_;
  Monitor &monitor_;
  const ConsistencyParameters &parameters_;
  std::uint64_t seed_;
  CavityOperator operator_;
  VolumeInsertion insertion_;
  ConsistencyCounts &counts_;
  std::vector<std::uint8_t> touched_; ///< vertices at new points of this round
  int allowance_ = first_allowance;
  Shell shell_;

  [[nodiscard]] bool is_touched(Index v) const {
    const auto i = static_cast<std::size_t>(v);
    return i >= touched_.size() || touched_[i] != 0;
  }
  void touch(std::span<const Index> cells) {
    touched_.resize(mesh_.vertices.size(), 1);
    for (Index c : cells)
      for (Index v : mesh_.at(c))
        touched_[static_cast<std::size_t>(v)] = 1;
  }

  /// Pick_valid (Algorithm 3) and Insert (Algorithm 1), or the split of a wall that the
  /// point encroaches upon. The circumcentre itself is tried first, then points of the
  /// picking region.
  bool insert_for(const BadCell<3> &item, int round) {
    const Vertex<3> star = mesh_.vertex(item.star);
    const Circumsphere<3> ball = circumsphere<3>(star.M, mesh_.simplex(item.cell));
    const EllipseSampler<3> ellipse(star.M);
    CounterRandom random(seed_ + 2, static_cast<std::uint64_t>(item.cell),
                         static_cast<std::uint64_t>(round));
    Pick best;
    HalfFacet wall;
    for (int k = 0; k < parameters_.candidates; ++k) {
      Vector<3> x = ball.centre;
      if (k > 0)
        x += ellipse.step(parameters_.delta * ball.radius, random);
      const VolumeWalk at = walk_to(mesh_, item.cell, x);
      if (at.cell == none) {
        wall = at.wall.exists() ? at.wall : wall;
        continue;
      }
      Pick found{
          {}, {}, at.cell, mesh_.background_cell[static_cast<std::size_t>(item.star)]};
      found.p = volume_.background.vertex(x, found.background);
      if (!insertion_.gather(found.p, std::array{at.cell}, {none, none}, quality_floor))
        continue;
      if (const HalfFacet near = insertion_.encroached(); near.exists()) {
        wall = near;
        continue;
      }
      found.score =
          insertion_.score(parameters_.sigma_0, parameters_.beta * ball.radius);
      if (found.score.is_better(best.score))
        best = found;
    }
    if (best.cell == none)
      return wall.exists() && split(wall);
    if (best.score.change > allowance_ || !insert(best))
      return false;
    counts_.add(item.rule);
    return true;
  }

  bool insert(const Pick &pick) {
    if (!insertion_.gather(pick.p, std::array{pick.cell}, {none, none}, quality_floor))
      return false;
    const Index v =
        volume_.add_vertex(pick.p, Triangulation<3>::interior, none, pick.background);
    return enter(v, {none, none});
  }

  /// Replaces the cavity that was gathered by the star of a new vertex.
  bool enter(Index v, std::array<Index, 2> lost) {
    touch(insertion_.cells());
    if (operator_.replace(insertion_.cells(), v, lost, {quality_floor}))
      return true;
    volume_.remove_vertex(v);
    return false;
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
    const Pick best = best_on_edge(feature);
    if (best.cell == none || best.score.change > allowance_ ||
        !insertion_.gather(best.p, shell_.all(), {a, b}, quality_floor))
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

  [[nodiscard]] Pick best_on_edge(const EdgeFeature &feature) {
    const Vector<3> &a = mesh_.vertex(shell_.a).x, &b = mesh_.vertex(shell_.b).x;
    Pick best;
    for (int k = 0; k < edge_candidates; ++k) {
      const double s = .5 + edge_part * (double(k) / (edge_candidates - 1) - .5);
      Pick found{{},
                 {},
                 shell_.cells[0],
                 mesh_.background_cell[static_cast<std::size_t>(shell_.a)]};
      found.p = volume_.background.vertex(
          volume_.surface.place(feature.dimension, feature.lies_on, a + s * (b - a)),
          found.background);
      if (!insertion_.gather(found.p, shell_.all(), {shell_.a, shell_.b},
                             quality_floor))
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
  Volume volume;
  DelaunayBits known;
  double failing;
};

void restore(Volume &volume, Volume &&from) {
  volume.mesh = std::move(from.mesh);
  volume.ridges = std::move(from.ridges);
  volume.support = std::move(from.support);
  volume.free_vertices = std::move(from.free_vertices);
  volume.quality = std::move(from.quality);
  volume.walled = std::move(from.walled);
  volume.cell_clock = std::move(from.cell_clock);
  volume.vertex_clock = std::move(from.vertex_clock);
}

/// Decides again where the mesh has changed since the clock showed `since`.
void renew(const Volume &volume, std::uint32_t since, int threads,
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
                known);
}

} // namespace

ConsistencyCounts refine_until_consistent(Volume &volume, Monitor &monitor,
                                          const ConsistencyParameters &parameters,
                                          std::uint64_t seed, int threads,
                                          bool relocate, DelaunayBits &known) {
  (void)relocate;
  ConsistencyCounts counts;
  Rounds rounds(volume, monitor, parameters, seed, counts);
  const double most =
      (1 + parameters.max_growth) * static_cast<double>(volume.n_vertices());
  std::optional<Snapshot> best(
      Snapshot{volume, known, failing_fraction(volume.mesh, known.bits)});
  int since_best = 0, allowance = first_allowance;
  for (counts.rounds = 0;; ++counts.rounds) {
    const std::vector<BadCell<3>> bad = rounds.bad_cells(known.bits);
    const double failing = failing_fraction(volume.mesh, known.bits);
    if (getenv("UC3"))
      fprintf(stderr, "round %d: nv %zu failing %.5f bad %zu allowance %d\n",
              counts.rounds, volume.n_vertices(), failing, bad.size(), allowance);
    if (failing < best->failing) {
      best.emplace(Snapshot{volume, known, failing});
      since_best = 0;
      allowance = first_allowance;
    } else if (counts.rounds > 0) {
      ++since_best;
      allowance = std::min(allowance + 1, last_allowance);
    }
    if (bad.empty())
      counts.stop = "consistent";
    else if (counts.rounds == max_rounds)
      counts.stop = "max_rounds";
    else if (static_cast<double>(volume.n_vertices()) > most)
      counts.stop = "max_growth";
    else if (since_best > patience)
      counts.stop = "stalled";
    else if (!monitor.keep_going(volume.n_vertices(), 0) ||
             !monitor.look(double(counts.rounds) / max_rounds))
      counts.stop = name_of(monitor.reason());
    if (!counts.stop.empty())
      break;
    const std::uint32_t since = ++volume.clock;
    (void)rounds.treat(bad, counts.rounds, allowance);
    renew(volume, since, threads, known);
  }
  if (failing_fraction(volume.mesh, known.bits) > best->failing) {
    restore(volume, std::move(best->volume));
    known = std::move(best->known);
  }
  return counts;
}

} // namespace anistar
