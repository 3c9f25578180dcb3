#pragma once
// Failures of the certificate that no test on one facet can see, and the loop that
// mends them by moving vertices; for meshes of triangles.

#include "base/run.h"
#include "certificate/delaunay_test.h"
#include "stars/certify_all.h"
#include "stars/rules.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace anistar {

/// What is looked at to mend a failing cell. The topology of the mesh stays.
class StarFailures {
public:
  explicit StarFailures(const Triangulation<2> &mesh)
      : mesh_(mesh), test_(certified(mesh)), seen_(mesh.cells.size(), 0) {}

  /// Vertices whose move could mend a cell: those found inside of its balls, its own,
  /// and those across its facets. Empty when it does not fail.
  [[nodiscard]] std::vector<Index> culprits(Index cell) {
    std::vector<Index> found;
    const auto add = [&](Index v) {
      if (std::find(found.begin(), found.end(), v) == found.end())
        found.push_back(v);
    };
    for (Index v : mesh_.at(cell))
      if (const Index inside = test_.violator(cell, mesh_.vertex(v).M); inside != none)
        add(inside);
    if (found.empty())
      return found;
    for (Index v : mesh_.at(cell))
      add(v);
    for (std::size_t i = 0; i < 3; ++i)
      if (const HalfFacet beyond = mesh_.opposite(HalfFacet(cell, i)); beyond.exists())
        add(mesh_.apex(beyond));
    return found;
  }

  /// Takes up the answers for the mesh as it is.
  void know(const std::vector<std::uint8_t> &bits) { known_ = bits; }

  /// Takes up the cells whose answer a move of one vertex can change: its star and
  /// three layers around it, but for accidents that the next round finds.
  void surround(std::span<const Index> star) {
    ++epoch_;
    n_star_ = star.size();
    cells_.assign(star.begin(), star.end());
    for (Index c : cells_)
      seen_[c] = epoch_;
    std::size_t begin = 0;
    for (int layer = 0; layer < 3; ++layer)
      for (const std::size_t end = cells_.size(); begin < end; ++begin)
        for (std::size_t i = 0; i < 3; ++i) {
          const HalfFacet beyond = mesh_.opposite(HalfFacet(cells_[begin], i));
          if (beyond.exists() && std::exchange(seen_[beyond.cell()], epoch_) != epoch_)
            cells_.push_back(beyond.cell());
        }
  }

  /// The first of them.
  [[nodiscard]] std::span<const Index> star() const { return {cells_.data(), n_star_}; }

  /// In how many stars these cells are missing.
  [[nodiscard]] int count() {
    int n = 0;
    for (Index c : cells_)
      n += missing(known(c));
    return n;
  }
  /// The same while v, whose star they surround, is elsewhere; not counted further than
  /// to `enough`. A cell away from v that is Delaunay stays so unless v is in a ball of
  /// it: there is no other new place.
  [[nodiscard]] int count_moved(Index v, int enough) {
    int n = 0;
    for (std::size_t k = 0; k < cells_.size() && n < enough; ++k)
      if (k < n_star_ || known(cells_[k]) != all_vertices<2> || may_hold(cells_[k], v))
        n += missing(test_.bits(cells_[k]));
    return n;
  }
  /// The vertex has moved.
  void forget() {
    for (Index c : cells_)
      known_[c] = unknown;
  }

private:
  const Triangulation<2> &mesh_;
  DelaunayTest<2> test_;
  std::vector<std::uint8_t> known_; ///< per cell, the answer before the trial
  std::vector<std::uint32_t> seen_; ///< per cell
  std::uint32_t epoch_ = 0;
  std::vector<Index> cells_;
  std::size_t n_star_ = 0;

  static constexpr std::uint8_t unknown = 255;

  [[nodiscard]] std::uint8_t known(Index c) {
    std::uint8_t &bits = known_[c];
    if (bits == unknown)
      bits = test_.bits(c);
    return bits;
  }
  [[nodiscard]] static int missing(std::uint8_t bits) {
    return 3 - std::popcount(static_cast<unsigned>(bits));
  }
  /// Whether one of the balls of a cell may have a vertex inside.
  [[nodiscard]] bool may_hold(Index c, Index v) const {
    const Simplex<2> s = mesh_.simplex(c);
    return std::any_of(mesh_.at(c).begin(), mesh_.at(c).end(), [&](Index of) {
      return !Circumball<2>(mesh_.vertex(of).M, s)
                  .power(mesh_.vertex(v).x)
                  .is_positive();
    });
  }
};

/// Mends failing cells by moving one vertex for each.
///
/// @tparam Relocation knows the mesh of its dimension: `star(v)`, the cells of a star,
/// and `relocate_where(v, radius, random, accept)`, which tries places ever further off
/// where nothing that agreement knows is worse, asks accept() when v is there, and
/// tells whether one was accepted; else v is where it was
template <class Relocation> class StarMender {
public:
  StarMender(const Triangulation<2> &mesh, Relocation &relocation, const Run &run)
      : mesh_(mesh), relocation_(relocation), failures_(mesh), run_(run) {}

  /// Moves the vertex inside the ball of a failing cell, one of its own or one across
  /// its facets, such that fewer cells around fail. @returns whether it found a move.
  bool mend(Index cell, int round) {
    for (Index v : failures_.culprits(cell)) { // none when an earlier move mended it
      failures_.surround(relocation_.star(v));
      const int failing = failures_.count();
      CounterRandom random(run_.seed, Stream::mend, v, round);
      if (!relocation_.relocate_where(v, farthest, random, [&] {
            return failures_.count_moved(v, failing) < failing;
          }))
        continue;
      changed_.insert(changed_.end(), failures_.star().begin(), failures_.star().end());
      failures_.forget();
      return true;
    }
    return false;
  }
  void know(const DelaunayBits &known) { failures_.know(known.bits); }
  /// Decides again where cells have changed, `done` being the part of the rounds
  /// behind.
  void renew(DelaunayBits &known, double done) {
    renew_bits<2>(certified(mesh_), changed_, run_.threads,
                  to_the_end(run_.monitor, done), known);
    changed_.clear();
  }

private:
  /// Metric distance up to which places are tried.
  static constexpr double farthest = .3;

  const Triangulation<2> &mesh_;
  Relocation &relocation_;
  StarFailures failures_;
  const Run &run_;
  std::vector<Index> changed_; ///< cells
};

/// More failures than this part of the cells are no accidents of an agreeing mesh.
inline constexpr double accidental = .005;

/// Mends the failing cells one by one, round by round; hopeless when there are many.
/// @param relocation see StarMender
/// @returns the number of moves; `known` is true of the mesh again
template <class Relocation>
std::size_t mend_failures(const Triangulation<2> &mesh, Relocation &relocation,
                          const Run &run, DelaunayBits &known) {
  constexpr int max_rounds = 8;
  std::size_t moves = 0;
  std::vector<Index> failing = failing_cells(mesh, known.bits);
  if (failing.empty() || static_cast<double>(failing.size()) >
                             accidental * static_cast<double>(mesh.n_cells()))
    return moves;
  StarMender<Relocation> mender(mesh, relocation, run);
  const auto go_on = [&](int round) {
    return run.monitor.look(double(round) / max_rounds);
  };
  for (int round = 0; round < max_rounds && !failing.empty() && go_on(round); ++round) {
    std::size_t moved = 0;
    mender.know(known);
    for (Index c : failing)
      if (go_on(round))
        moved += mender.mend(c, round);
    if (moved == 0)
      break;
    moves += moved;
    mender.renew(known, double(round) / max_rounds);
    failing = failing_cells(mesh, known.bits);
  }
  return moves;
}

} // namespace anistar
