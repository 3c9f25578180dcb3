#include "star_check.h"

#include "consistency_rules.h"
#include "moves.h"
#include "relocation.h"

#include <bit>
#include <utility>

namespace anistar {
namespace {

constexpr int max_rounds = 8;
/// Trial places of each vertex that could mend a failure.
constexpr int n_candidates = 16;
constexpr double radius = .3;
/// More failures than this fraction of the cells are no accidents of an agreeing mesh.
constexpr double few = .005;

class Mender {
public:
  Mender(Workspace &w, std::uint64_t seed)
      : w_(w), mesh_(w.mesh), seed_(seed), relocation_(w),
        test_({mesh_.vertices, mesh_.cells, mesh_.neighbours, mesh_.constraints}),
        seen_(mesh_.cells.size(), 0) {}

  /// Moves the vertex inside the ball of a failing cell, one of its own or one across
  /// its edges, such that fewer cells around fail. @returns whether it found a move.
  bool mend(Index cell, int round) {
    std::vector<Index> culprits;
    for (Index v : mesh_.at(cell)) {
      const Index inside = test_.violator(cell, mesh_.vertex(v).M);
      if (inside != none &&
          std::find(culprits.begin(), culprits.end(), inside) == culprits.end())
        culprits.push_back(inside);
    }
    if (culprits.empty())
      return false; // an earlier move has mended it
    culprits.insert(culprits.end(), mesh_.at(cell).begin(), mesh_.at(cell).end());
    for (std::size_t i = 0; i < 3; ++i)
      if (const HalfFacet beyond = mesh_.opposite(HalfFacet(cell, i)); beyond.exists())
        culprits.push_back(mesh_.apex(beyond));
    for (Index v : culprits)
      if (mesh_.feature[static_cast<std::size_t>(v)] == Triangulation<2>::interior &&
          move(v, round))
        return true;
    return false;
  }

  /// The cells of the stars that were moved since the last call.
  [[nodiscard]] std::vector<Index> take_changed() {
    return std::exchange(changed_, {});
  }
  /// As the certificate sees one cell now.
  [[nodiscard]] DelaunayTest<2> &test() { return test_; }

private:
  Workspace &w_;
  Triangulation<2> &mesh_;
  std::uint64_t seed_;
  Relocation relocation_;
  DelaunayTest<2> test_;
  std::vector<std::uint32_t> seen_;
  std::uint32_t epoch_ = 0;
  std::vector<Index> changed_;

  /// Cells within three layers of the star: those whose ball can reach the vertex, but
  /// for accidents that the next round finds.
  [[nodiscard]] std::vector<Index> cells_around() {
    ++epoch_;
    std::vector<Index> cells;
    const auto add = [&](Index c) {
      if (std::exchange(seen_[static_cast<std::size_t>(c)], epoch_) != epoch_)
        cells.push_back(c);
    };
    for (HalfFacet h : relocation_.star())
      add(h.cell());
    std::size_t begin = 0;
    for (int layer = 0; layer < 3; ++layer) {
      const std::size_t end = cells.size();
      for (; begin < end; ++begin)
        for (std::size_t i = 0; i < 3; ++i) {
          const HalfFacet beyond = mesh_.opposite(HalfFacet(cells[begin], i));
          if (beyond.exists())
            add(beyond.cell());
        }
    }
    return cells;
  }

  [[nodiscard]] int failures(const std::vector<Index> &cells) {
    int n = 0;
    for (Index c : cells)
      n += 3 - std::popcount(static_cast<unsigned>(test_.bits(c)));
    return n;
  }

  bool move(Index v, int round) {
    relocation_.gather(v);
    const Place from = relocation_.here();
    const StarScore before = relocation_.score();
    const std::vector<Index> cells = cells_around();
    const int failing = failures(cells);
    CounterRandom random(seed_ ^ 0x5741u, static_cast<std::uint64_t>(v),
                         static_cast<std::uint64_t>(round));
    const EllipseSampler ellipse(from.vertex.M);
    for (int k = 0; k < n_candidates; ++k) {
      const Vector<2> x =
          from.vertex.x + ellipse.step(radius * (k + 1) / n_candidates, random);
      if (!may_move(mesh_, from.vertex.x, x, relocation_.star()))
        continue;
      relocation_.put(relocation_.at(x));
      const StarScore found = relocation_.score();
      if (found.keeps(before) && found.disagreeing <= before.disagreeing &&
          failures(cells) < failing) {
        for (HalfFacet h : relocation_.star())
          changed_.push_back(h.cell());
        return true;
      }
      relocation_.put(from);
    }
    return false;
  }
};

std::vector<Index> failing_cells(const std::vector<std::uint8_t> &bits) {
  std::vector<Index> cells;
  for (std::size_t c = 0; c < bits.size(); ++c)
    if (bits[c] != all_vertices<2>)
      cells.push_back(static_cast<Index>(c));
  return cells;
}

} // namespace

StarCheck check_stars(Workspace &w, Monitor &monitor, std::uint64_t seed, int threads,
                      bool mend) {
  const Triangulation<2> &mesh = w.mesh;
  DelaunayBits found = delaunay_bits<2>(
      {mesh.vertices, mesh.cells, mesh.neighbours, mesh.constraints}, threads);
  std::vector<Index> failing = failing_cells(found.bits);
  StarCheck check;
  check.failures = failing.size();
  const bool hopeless =
      static_cast<double>(failing.size()) > few * static_cast<double>(mesh.n_cells());
  if (mend && !hopeless && !failing.empty()) {
    Mender mender(w, seed);
    for (int round = 0; round < max_rounds && !failing.empty() &&
                        monitor.look(double(round) / max_rounds);
         ++round) {
      std::size_t moves = 0;
      for (Index c : failing)
        if (monitor.keep_going(0, 0))
          moves += mender.mend(c, round);
      check.moves += moves;
      if (moves == 0)
        break;
      for (Index c :
           dependent_cells<2>(mesh.neighbours, mender.take_changed(), found.reach)) {
        found.bits[static_cast<std::size_t>(c)] = mender.test().bits(c);
        found.reach[static_cast<std::size_t>(c)] = mender.test().reach();
      }
      failing = failing_cells(found.bits);
    }
  }
  check.bits = std::move(found.bits);
  const CertifiedFractions fractions = certified_fractions(mesh, check.bits);
  check.simplex_ok = fractions.simplex_ok;
  check.star_ok = fractions.star_ok;
  return check;
}

} // namespace anistar
