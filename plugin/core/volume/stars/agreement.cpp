#include "volume/stars/agreement.h"

#include "volume/stars/facet_repair.h"

#include <utility>

namespace anistar {
namespace {

constexpr int max_rounds = 60;
/// Rounds that may pass without clearly fewer failing facets; more when only a few are
/// left, for a round costs nothing then.
constexpr int patience = 6, patience_with_few = 25;
constexpr std::size_t few = 100;
constexpr double least_reduction = .05;
/// The radius of the trial places, round by round.
constexpr double radii[] = {.3, .15, .07};
/// Every so many rounds collapses and insertions are tried.
constexpr int repair_period = 5;
/// From this round on vertices at a facet that resists wander, by this much: where
/// metrics vary a lot the rest is stuck without.
constexpr int first_wandering = 3;
constexpr double wandering_radius = .1;
/// A bound on the trial places; the metrics that could be certified, but for a few
/// cells, took a third of it.
constexpr std::size_t trials_per_cell = 20;
/// Re-insertion finds most of what it can in the first round: it is tried every so
/// many.
constexpr int reinsertion_period = 3;
constexpr int max_polish_sweeps = 2;
/// The monitor looks at the clock and at the user after so many facets, a few
/// milliseconds.
constexpr std::size_t calls_between_looks = 64;

class VolumeAgreement {
public:
  VolumeAgreement(Volume &volume, const Run &run, int persistence)
      : volume_(volume), mesh_(volume.mesh), run_(run), persistence_(persistence),
        state_(volume, run.hausdorff.surface), relocation_(state_),
        repair_(state_, run.monitor) {}

  AgreementCounts run() {
    const std::uint32_t start = ++volume_.clock;
    state_.margins.fill(run_.threads);
    scan();
    counts_.before = failing_.size();
    counts_.stop = reduce();
    polish(start);
    counts_.after = failing_.size();
    counts_.trials = relocation_.trials();
    return counts_;
  }

private:
  Volume &volume_;
  const Triangulation<3> &mesh_;
  const Run &run_;
  int persistence_;
  AgreementState state_;
  VolumeRelocation relocation_;
  FacetRepair repair_;
  std::vector<HalfFacet> failing_; ///< each from its first cell, sorted
  AgreementCounts counts_;
  std::size_t calls_ = 0;

  [[nodiscard]] bool go_on(double fraction) {
    return ++calls_ % calls_between_looks == 0 ? run_.monitor.look(fraction)
                                               : !run_.is_stopped();
  }
  [[nodiscard]] bool still_fails(HalfFacet h) {
    return mesh_.is_alive(h.cell()) && state_.margins.fails(h);
  }

  /// The one search of the mesh.
  void scan() {
    for (std::size_t k = 0; k < mesh_.cells.size(); ++k) {
      const auto c = static_cast<Index>(k);
      for (std::size_t i = 0; mesh_.is_alive(c) && i < 4; ++i)
        if (mesh_.opposite(HalfFacet(c, i)).cell() > c)
          list(HalfFacet(c, i), failing_);
    }
  }

  /// Adds a failing facet as seen from its first cell.
  void list(HalfFacet h, std::vector<HalfFacet> &to) {
    if (mesh_.opposite(h).exists() && state_.margins.fails(h))
      to.push_back(std::min(h, mesh_.opposite(h), before));
  }
  static bool before(HalfFacet a, HalfFacet b) {
    return a.cell() != b.cell() ? a.cell() < b.cell() : a.facet() < b.facet();
  }

  /// What was on the list and what changed, looked at again.
  void update_list() {
    std::vector<HalfFacet> left;
    for (HalfFacet h : failing_)
      if (mesh_.is_alive(h.cell()))
        list(h, left);
    std::sort(state_.changed.begin(), state_.changed.end());
    Index last = none;
    for (Index c : state_.changed)
      if (std::exchange(last, c) != c && mesh_.is_alive(c))
        for (std::size_t i = 0; i < 4; ++i)
          list(HalfFacet(c, i), left);
    state_.changed.clear();
    std::sort(left.begin(), left.end(), before);
    left.erase(std::unique(left.begin(), left.end()), left.end());
    failing_ = std::move(left);
  }

  AgreementStop reduce() {
    std::size_t fewest = failing_.size();
    int since = 0; // the last time there were clearly fewer
    const int last_round = persistence_ * max_rounds;
    const std::size_t most_trials = trials_per_cell * mesh_.n_cells() * persistence_;
    for (int round = 0; round < last_round; ++round) {
      if (failing_.empty())
        return AgreementStop::agreed;
      ++counts_.rounds;
      const bool is_going = visit_failing(round);
      update_list();
      if (!is_going)
        return AgreementStop::interrupted;
      if (relocation_.trials() > most_trials)
        return AgreementStop::trials;
      ++since;
      if (static_cast<double>(failing_.size()) <
          (1 - least_reduction) * static_cast<double>(fewest)) {
        fewest = failing_.size();
        since = 0;
      }
      if (since >=
          persistence_ * (failing_.size() <= few ? patience_with_few : patience))
        return AgreementStop::stalled;
    }
    return failing_.empty() ? AgreementStop::agreed : AgreementStop::rounds;
  }

  bool visit_failing(int round) {
    const bool is_repairing = round % repair_period == repair_period - 1;
    for (std::size_t k = 0; k < failing_.size(); ++k) {
      if (!go_on(static_cast<double>(round) / (persistence_ * max_rounds)))
        return false;
      const HalfFacet h = failing_[k];
      if (!still_fails(h))
        continue;
      CounterRandom random(run_.seed, Stream::repair_facet, h.code(), round);
      if (is_repairing)
        counts_.repairs += repair_.collapse_or_insert(h, random);
      else
        mend(h, round, random);
    }
    return true;
  }

  void mend(HalfFacet h, int round, CounterRandom &random) {
    const double radius = radii[round % 3];
    // a swap that only exchanges failing facets could be taken back for ever
    if (repair_.swap(h, round % 2 == 0 ? FacetRepair::Demand::lower_cost
                                       : FacetRepair::Demand::fewer_failing)) {
      ++counts_.swaps;
      return;
    }
    const Facet<3> t = mesh_.facet(h);
    const std::array<Index, 5> vertices{t[0], t[1], t[2], mesh_.apex(h),
                                        mesh_.apex(mesh_.opposite(h))};
    const auto first = static_cast<std::size_t>(5 * random.uniform());
    for (std::size_t k = 0; k < 5; ++k) {
      const Index v = vertices[(first + k) % 5];
      if (round % reinsertion_period == 0)
        counts_.reinsertions += repair_.reinsert(v);
      counts_.moves += relocation_.relocate(v, radius, random);
      if (!still_fails(h))
        return;
    }
    if (round >= first_wandering)
      counts_.moves += relocation_.wander(vertices[first], wandering_radius, random);
  }

  /// Takes back what agreement cost in shape, where it changed something.
  void polish(std::uint32_t since) {
    const std::size_t n = mesh_.vertices.size();
    for (int sweep = 0; sweep < max_polish_sweeps; ++sweep) {
      std::size_t done = 0;
      for (std::size_t v = 0; v < n && go_on(1); ++v)
        if (mesh_.is_used(static_cast<Index>(v)) && volume_.vertex_clock[v] >= since)
          done += relocation_.polish(static_cast<Index>(v));
      counts_.polishes += done;
      if (done == 0)
        break;
    }
    update_list();
  }
};

} // namespace

AgreementCounts agree(Volume &volume, const Run &run, int persistence) {
  return VolumeAgreement(volume, run, persistence).run();
}

} // namespace anistar
