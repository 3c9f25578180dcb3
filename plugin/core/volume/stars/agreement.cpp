#include "volume/stars/agreement.h"

#include "volume/mesh/slab_team.h"
#include "volume/stars/facet_repair.h"
#include "volume/stars/relocation.h"

#include <utility>

namespace anistar {
namespace {

/// The first rounds make directed steps, which mend nine facets of ten, and then every
/// so many: what is changed in between lets some more succeed.
constexpr int n_directed = 3, directed_period = 3;
/// The radius of the random places in the rounds between directed ones.
constexpr double radii[] = {.15, .07};
/// The last failing facets get so many places a vertex; in every so many rounds the
/// vertices around them make room: what is left resists because others are near.
constexpr std::size_t last_failing = 30;
constexpr int last_places = 24, room_period = 2;
/// Every so many rounds, but for the directed ones, collapses and insertions are tried;
/// where many facets fail not at once: they cost far more than a move, and vertices.
constexpr int first_repair = 9, repair_period = 5;
/// A facet that resists in these rounds makes a vertex wander, by this much: where
/// metrics vary a lot the rest is stuck without.
constexpr double wandering_radius = .1;
/// What a round takes for each failing facet, about.
constexpr std::size_t directed_trials = 3, random_trials = 25;
/// Re-insertion finds most of what it can in the first round: it is tried in every so
/// many, but for the directed ones.
constexpr int reinsertion_period = 4;
/// Only stars with a cell that lost so much are polished.
constexpr float clear_loss = .02F;
constexpr int n_last_polishes = 2;
/// The monitor looks at the clock and at the user after so many facets, a few
/// milliseconds.
constexpr std::size_t calls_between_looks = 64;

/// A mesh may rest when less than this part of its facets fails, and this part of the
/// edges of some cells is of about unit length.
constexpr double nearly_agreed = .005, mostly = .9;
constexpr double shortest_unit_edge = .7, longest_unit_edge = 1.42;
constexpr std::size_t sampled_cells = 4096;

/// What the threads do side by side.
struct MoveCounts {
  std::size_t moves = 0, trials = 0;
  std::vector<Index> changed; ///< cells

  MoveCounts &operator+=(const MoveCounts &other) {
    moves += other.moves;
    trials += other.trials;
    changed.insert(changed.end(), other.changed.begin(), other.changed.end());
    return *this;
  }
};

/// The visitor of a slab team that moves vertices: move(relocation, item) tells whether
/// it did.
template <class Move> class SlabMoves {
public:
  SlabMoves(Volume &volume, AgreementState &state, double hausdorff_number,
            const Move &move)
      : view_{volume, state, hausdorff_number}, relocation_(view_), move_(move) {}

  MoveCounts counts;

  void visit(Index item) {
    counts.moves += move_(relocation_, item);
    counts.trials = relocation_.trials();
    counts.changed.insert(counts.changed.end(), view_.changed.begin(),
                          view_.changed.end());
    view_.changed.clear();
  }

private:
  AgreementView view_;
  VolumeRelocation relocation_;
  const Move &move_;
};

class VolumeAgreement {
public:
  VolumeAgreement(Volume &volume, const Run &run)
      : volume_(volume), mesh_(volume.mesh), run_(run),
        state_(volume, run.threads), view_{volume, state_, run.hausdorff.surface},
        relocation_(view_), repair_(view_, run.monitor) {}

  AgreementCounts make(const AgreementEffort &effort) {
    start_ = ++volume_.clock;
    quality_before_ = volume_.quality;
    state_.margins.fill(run_.threads);
    scan();
    counts_.before = failing_.size();
    counts_.stop = reduce(RoundLimits(effort, mesh_.n_cells(), failing_.size()));
    polish_at_last();
    counts_.after = failing_.size();
    counts_.trials += relocation_.trials();
    return counts_;
  }

private:
  Volume &volume_;
  const Triangulation<3> &mesh_;
  const Run &run_;
  AgreementState state_;
  AgreementView view_;
  VolumeRelocation relocation_;
  FacetRepair repair_;
  std::vector<HalfFacet> failing_; ///< each from its first cell, sorted
  std::uint32_t start_ = 0;
  PerCell<float> quality_before_;
  AgreementCounts counts_;
  std::size_t calls_ = 0;

  [[nodiscard]] bool go_on(double fraction) {
    return ++calls_ % calls_between_looks == 0 ? run_.monitor.look(fraction)
                                               : !run_.is_stopped();
  }
  [[nodiscard]] bool still_fails(HalfFacet h) {
    return mesh_.is_alive(h.cell()) && state_.margins.fails(h);
  }
  [[nodiscard]] std::size_t n_trials() const {
    return counts_.trials + relocation_.trials();
  }

  /// The one search of the mesh.
  void scan() {
    for (std::size_t k = 0; k < mesh_.cells.size(); ++k) {
      const auto c = static_cast<Index>(k);
      for (std::size_t i = 0; mesh_.is_alive(c) && i < 4; ++i)
        if (const HalfFacet beyond = mesh_.opposite(HalfFacet(c, i));
            !beyond.exists() || beyond.cell() > c)
          list(HalfFacet(c, i), failing_);
    }
  }

  /// Adds a failing facet as seen from its first cell.
  void list(HalfFacet h, std::vector<HalfFacet> &to) {
    if (state_.margins.fails(h))
      to.push_back(first_side(mesh_, h));
  }

  /// What was on the list and what changed, looked at again.
  void update_list() {
    std::vector<HalfFacet> left;
    for (HalfFacet h : failing_)
      if (mesh_.is_alive(h.cell()))
        list(h, left);
    std::sort(view_.changed.begin(), view_.changed.end());
    Index last = none;
    for (Index c : view_.changed)
      if (std::exchange(last, c) != c && mesh_.is_alive(c))
        for (std::size_t i = 0; i < 4; ++i)
          list(HalfFacet(c, i), left);
    view_.changed.clear();
    std::sort(left.begin(), left.end());
    left.erase(std::unique(left.begin(), left.end()), left.end());
    failing_ = std::move(left);
  }

  [[nodiscard]] static bool is_directed(int round) {
    return round < n_directed || round % directed_period == 0;
  }
  AgreementStop reduce(RoundLimits limits) {
    for (int round = 0; round < limits.last_round(); ++round) {
      if (failing_.empty())
        return AgreementStop::agreed;
      ++counts_.rounds;
      const double fraction = static_cast<double>(round) / limits.last_round();
      const bool is_going =
          is_directed(round) ? step_all(round) : visit_failing(round, fraction);
      update_list();
      if (!is_going)
        return AgreementStop::interrupted;
      if (const auto stop =
              limits.stop(failing_.size(), n_trials(),
                          is_directed(round + 1) ? directed_trials : random_trials))
        return *stop;
      if (round + 1 == n_directed && failing_.size() > few_failing_facets)
        (void)polish(start_);
    }
    return failing_.empty() ? AgreementStop::agreed : AgreementStop::rounds;
  }

  [[nodiscard]] CounterRandom random_at(HalfFacet h, int round) const {
    return {run_.seed, Stream::repair_facet, h.code(),
            static_cast<std::uint32_t>(round)};
  }

  /// Moves on several threads. @returns how many
  template <class SlabOf, class Move>
  std::size_t move_by_slabs(std::vector<Index> items, SlabOf slab_of,
                            const Move &move) {
    SlabTeam<SlabMoves<Move>> team(volume_, run_, [&](Volume &seen) {
      return SlabMoves<Move>(seen, state_, run_.hausdorff.surface, move);
    });
    const MoveCounts made = team.visit(std::move(items), slab_of);
    counts_.trials += made.trials;
    view_.changed.insert(view_.changed.end(), made.changed.begin(), made.changed.end());
    return made.moves;
  }
  [[nodiscard]] std::size_t slab_of_vertex(Index v, int slab_round) const {
    // the graph of ridges is no slab's
    return volume_.feature(v) <= 1 ? Slabs::nowhere
                                   : volume_.state.slabs.of_star(v, slab_round);
  }
  [[nodiscard]] std::size_t slab_of_facet(HalfFacet h, int slab_round) const {
    const DecidingVertices vertices(mesh_, h);
    const std::size_t slab = slab_of_vertex(vertices[0], slab_round);
    const bool is_one = std::all_of(vertices.begin(), vertices.end(), [&](Index v) {
      return slab_of_vertex(v, slab_round) == slab;
    });
    return is_one ? slab : Slabs::nowhere;
  }

  /// A round of directed steps, and of swaps of what resists them.
  bool step_all(int round) {
    std::vector<Index> items(failing_.size());
    std::iota(items.begin(), items.end(), 0);
    counts_.moves += move_by_slabs(
        std::move(items),
        [&](Index k, int slab_round) { return slab_of_facet(failing_[k], slab_round); },
        [&](VolumeRelocation &relocation, Index k) {
          return step_at(relocation, failing_[k], round);
        });
    for (std::size_t k = 0; round > 0 && k < failing_.size() && go_on(0); ++k)
      if (still_fails(failing_[k]))
        counts_.swaps += repair_.swap(failing_[k], FacetRepair::Demand::fewer_failing);
    return !run_.is_stopped();
  }
  std::size_t step_at(VolumeRelocation &relocation, HalfFacet h, int round) {
    CounterRandom random = random_at(h, round);
    const DecidingVertices vertices(mesh_, h);
    const std::size_t n = vertices.size(), first = random.below(n);
    std::size_t moves = 0;
    for (std::size_t k = 0; k < n && state_.margins.fails(h); ++k)
      moves += relocation.step(vertices[(first + k) % n]);
    return moves;
  }

  bool visit_failing(int round, double fraction) {
    const bool is_repairing =
        (round >= first_repair || failing_.size() <= few_failing_facets) &&
        round % repair_period == repair_period - 1;
    for (std::size_t k = 0; k < failing_.size(); ++k) {
      if (!go_on(fraction))
        return false;
      const HalfFacet h = failing_[k];
      if (!still_fails(h))
        continue;
      CounterRandom random = random_at(h, round);
      if (is_repairing)
        counts_.repairs += repair_.collapse_or_insert(h, random);
      else
        mend(h, round, random);
    }
    return true;
  }

  void mend(HalfFacet h, int round, CounterRandom &random) {
    const bool is_among_last = failing_.size() <= last_failing;
    RandomPlaces places{radii[round % directed_period - 1]};
    if (is_among_last)
      places.n = last_places;
    // a swap that only exchanges failing facets could be taken back for ever
    if (repair_.swap(h, round % 2 == 0 ? FacetRepair::Demand::lower_cost
                                       : FacetRepair::Demand::fewer_failing)) {
      ++counts_.swaps;
      return;
    }
    const DecidingVertices vertices(mesh_, h);
    const std::size_t n = vertices.size(), first = random.below(n);
    for (std::size_t k = 0; k < n; ++k) {
      const Index v = vertices[(first + k) % n];
      if (round % reinsertion_period == 0)
        counts_.reinsertions += repair_.reinsert(v);
      counts_.moves += relocation_.relocate(v, places, random);
      if (!still_fails(h))
        return;
    }
    counts_.moves += relocation_.wander(vertices[first], wandering_radius, random);
    if (is_among_last && round % room_period == 1)
      make_room(vertices, places, random);
  }
  /// Of the vertices that have an edge with those that decide.
  void make_room(const DecidingVertices &deciding, const RandomPlaces &places,
                 CounterRandom &random) {
    std::vector<Index> around, star;
    volume_.open_vertices();
    for (Index v : deciding)
      (void)volume_.mark_vertex(v);
    for (Index v : deciding) {
      star_of(volume_, v, star);
      for (Index c : star)
        for (Index u : mesh_.at(c))
          if (volume_.mark_vertex(u))
            around.push_back(u);
    }
    for (Index u : around)
      counts_.moves += relocation_.make_room(u, places, random);
  }

  void polish_at_last() {
    std::uint32_t since = start_;
    for (int k = 0; k < n_last_polishes; ++k) {
      const std::uint32_t now = ++volume_.clock;
      if (polish(since) == 0)
        break;
      since = now;
    }
  }

  /// Takes back what agreement cost in shape, where stars have changed since then.
  /// @returns the number of moves
  std::size_t polish(std::uint32_t since) {
    const std::size_t done = move_by_slabs(
        worse_vertices(since),
        [&](Index v, int slab_round) { return slab_of_vertex(v, slab_round); },
        [](VolumeRelocation &relocation, Index v) { return relocation.polish(v); });
    counts_.polishes += done;
    update_list();
    return done;
  }

  /// The vertices of cells that are clearly worse than before, or new.
  [[nodiscard]] std::vector<Index> worse_vertices(std::uint32_t since) const {
    PerVertex<std::uint8_t> is_worse(mesh_.vertices.size(), 0);
    for (std::size_t k = 0; k < mesh_.cells.size(); ++k) {
      const auto c = static_cast<Index>(k);
      if (mesh_.is_alive(c) && volume_.cell_clock[k] >= start_ &&
          (k >= quality_before_.size() ||
           volume_.quality[k] < quality_before_[k] - clear_loss))
        for (Index v : mesh_.at(c))
          is_worse[v] = volume_.vertex_clock[v] >= since;
    }
    std::vector<Index> found;
    for (std::size_t v = 0; v < is_worse.size(); ++v)
      if (is_worse[v] != 0)
        found.push_back(static_cast<Index>(v));
    return found;
  }
};

} // namespace

namespace {

/// Whether most edges of a sample of the cells are of about unit length.
bool has_unit_edges(const Triangulation<3> &mesh) {
  const std::size_t step = std::max<std::size_t>(1, mesh.cells.size() / sampled_cells);
  std::size_t n = 0, unit = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); c += step)
    for (std::size_t i = 0; i < 4; ++i) {
      const Index v = mesh.cells[c][i], w = mesh.cells[c][(i + 1) % 4];
      const double length = fast_length(mesh.vertex(v), mesh.vertex(w));
      ++n;
      unit += length > shortest_unit_edge && length < longest_unit_edge;
    }
  return static_cast<double>(unit) > mostly * static_cast<double>(n);
}

} // namespace

void rest_where_agreed(Volume &volume, const Run &run) {
  const Triangulation<3> &mesh = volume.mesh;
  if (!has_unit_edges(mesh))
    return;
  const SurfaceNormals normals(volume, run.threads);
  FacetMargins margins(mesh, normals);
  margins.fill(run.threads);
  PerVertex<std::uint8_t> agrees(mesh.vertices.size(), 1);
  std::size_t failing = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (std::size_t i = 0; i < 4; ++i)
      if (margins.fails(HalfFacet(static_cast<Index>(c), i))) {
        ++failing;
        for (Index v : mesh.cells[c])
          agrees[v] = 0;
      }
  // each facet was seen from both cells
  if (static_cast<double>(failing) <
      nearly_agreed * 4 * static_cast<double>(mesh.cells.size()))
    volume.at_rest = std::move(agrees);
}

AgreementCounts agree(Volume &volume, const Run &run, const AgreementEffort &effort) {
  return VolumeAgreement(volume, run).make(effort);
}

} // namespace anistar
