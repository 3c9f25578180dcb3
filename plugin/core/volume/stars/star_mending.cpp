#include "volume/stars/star_mending.h"

#include "certificate/delaunay_test.h"
#include "stars/certify_all.h"
#include "stars/rules.h"
#include "volume/stars/relocation.h"

#include <numeric>
#include <utility>

namespace anistar {
namespace {

constexpr int max_rounds = 8;
/// The rounds go on while one leaves less than this part of the failing cells.
constexpr double good_progress = .9;
/// With so few failures it costs nothing, and they go on while vertices move.
constexpr std::size_t last_failing = 10;
/// From this round on random places are tried too, within this metric distance.
constexpr int first_random = 1;
constexpr RandomPlaces random_places{.radius = .1, .n = 12};
/// The monitor looks at the clock and at the user after so many failures.
constexpr std::size_t failures_between_looks = 32;

class VolumeMender {
public:
  VolumeMender(Volume &volume, const Run &run, DelaunayBits &known)
      : volume_(volume), mesh_(volume.mesh), run_(run), known_(known),
        test_(certified(mesh_)),
        state_(volume, run.threads), view_{volume, state_, run.hausdorff.surface},
        relocation_(view_) {}

  MendingCounts mend(double mended_part) {
    MendingCounts counts;
    std::vector<Index> everywhere(mesh_.cells.size());
    std::iota(everywhere.begin(), everywhere.end(), 0);
    Failures failing = failures(everywhere, {}, 0);
    const double most = mended_part * double(mesh_.n_cells());
    if (double(failing.cells.size()) > most || double(failing.walls.size()) > most)
      return counts;
    bool is_progressing = true;
    for (int round = 0; round < max_rounds && is_progressing && failing.size() > 0 &&
                        run_.monitor.look(fraction_of(round));
         ++round) {
      const std::size_t before = failing.size(), moved = move_at(failing, round);
      const std::vector<Index> changed = renew(fraction_of(round));
      counts.moves += moved;
      failing = failures(changed, failing.walls, fraction_of(round));
      const bool is_cheap = failing.size() <= last_failing;
      is_progressing = round < first_random ||
                       (moved > 0 && (is_cheap || double(failing.size()) <=
                                                      good_progress * double(before)));
    }
    counts.more_failing = view_.more_failing;
    return counts;
  }

private:
  Volume &volume_;
  const Triangulation<3> &mesh_;
  const Run &run_;
  DelaunayBits &known_;
  DelaunayTest<3> test_;
  AgreementState state_;
  AgreementView view_;
  VolumeRelocation relocation_;

  struct Failures {
    std::vector<Index> cells;
    std::vector<WallViolation> walls;

    [[nodiscard]] std::size_t size() const { return cells.size() + walls.size(); }
  };
  /// @param changed cells, in order; walls elsewhere fail as before
  [[nodiscard]] Failures failures(std::span<const Index> changed,
                                  std::span<const WallViolation> before,
                                  double fraction) const {
    std::vector<HalfFacet> walls;
    for (const WallViolation &violation : before)
      walls.push_back(violation.wall);
    for (Index c : changed)
      for (std::size_t i = 0; mesh_.is_alive(c) && volume_.is_walled(c) && i < 4; ++i)
        if (const HalfFacet h(c, i); mesh_.constraint(h) != none)
          walls.push_back(first_side(mesh_, h));
    std::sort(walls.begin(), walls.end());
    walls.erase(std::unique(walls.begin(), walls.end()), walls.end());
    return {failing_cells(mesh_, known_.bits),
            wall_violations(mesh_, state_.normals, walls, run_.threads,
                            to_the_end(run_.monitor, fraction))};
  }
  [[nodiscard]] static double fraction_of(int round) {
    return double(round) / max_rounds;
  }
  [[nodiscard]] bool goes_on(std::size_t k, int round) const {
    return k % failures_between_looks == 0 ? run_.monitor.look(fraction_of(round))
                                           : !run_.is_stopped();
  }

  /// One vertex after another of every violation moves until it is none.
  std::size_t move_at(const Failures &failing, int round) {
    std::size_t moves = 0;
    std::vector<FarViolation> found = violations(failing.cells, round);
    add_violations(failing.walls, found);
    for (std::size_t n = 0; n < found.size() && goes_on(n, round); ++n) {
      const FarViolation &violation = found[n];
      const std::array<Index, 5> &vertices = violation.vertices;
      CounterRandom random(run_.seed, Stream::mend, vertices[0], round);
      const std::size_t first = random.below(vertices.size());
      for (std::size_t k = 0; k < vertices.size() && is_violated(violation); ++k) {
        const Index v = vertices[(first + k) % vertices.size()];
        moves +=
            v != none &&
            (relocation_.step(v) ||
             (round >= first_random && relocation_.relocate(v, random_places, random)));
      }
    }
    return moves;
  }
  [[nodiscard]] bool is_violated(const FarViolation &violation) const {
    return margin_of(star_of(mesh_, state_.normals, violation)) > 0;
  }

  /// What makes cells fail. That which no facet tells of is watched from now on.
  [[nodiscard]] std::vector<FarViolation> violations(const std::vector<Index> &failing,
                                                     int round) {
    std::vector<FarViolation> found;
    for (std::size_t n = 0; n < failing.size() && goes_on(n, round); ++n) {
      const Index c = failing[n];
      const Cell<3> &cell = mesh_.at(c);
      for (std::size_t k = 0; k < 4; ++k) {
        if ((known_.bits[c] >> k & 1) != 0)
          continue;
        const Index w = test_.violator(c, mesh_.vertex(cell[k]).M);
        const FarViolation violation{{cell[0], cell[1], cell[2], cell[3], w}};
        if (w == none || (!found.empty() && found.back() == violation))
          continue;
        found.push_back(violation);
        if (is_neighbour(c, w))
          continue;
        watch(violation);
      }
    }
    return found;
  }
  void add_violations(const std::vector<WallViolation> &walls,
                      std::vector<FarViolation> &to) {
    for (const auto &[wall, inside] : walls) {
      const Facet<3> t = mesh_.facet(wall);
      to.push_back({{t[0], t[1], t[2], none, inside}, mesh_.constraint(wall)});
      const HalfFacet beyond = mesh_.opposite(wall);
      if (inside != mesh_.apex(wall) &&
          (!beyond.exists() || inside != mesh_.apex(beyond)))
        watch(to.back());
    }
  }
  void watch(const FarViolation &violation) {
    state_.far.add(violation);
    for (Index v : violation.vertices)
      if (v != none)
        state_.is_stuck[v] = 0;
  }
  [[nodiscard]] bool is_neighbour(Index c, Index w) const {
    for (std::size_t i = 0; i < 4; ++i)
      if (const HalfFacet beyond = mesh_.opposite(HalfFacet(c, i));
          beyond.exists() && mesh_.apex(beyond) == w)
        return true;
    return false;
  }

  /// Decides again for what depends on the cells that have changed: to the end, or the
  /// answers would be those of another mesh.
  /// @returns these
  std::vector<Index> renew(double fraction) {
    renew_bits<3>(certified(mesh_), view_.changed, run_.threads,
                  to_the_end(run_.monitor, fraction), known_);
    return std::exchange(view_.changed, {});
  }
};

} // namespace

MendingCounts mend_stars(Volume &volume, const Run &run, const AgreementEffort &effort,
                         DelaunayBits &known) {
  return VolumeMender(volume, run, known).mend(effort.mended_part);
}

} // namespace anistar
