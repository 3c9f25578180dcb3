#include "plane/stars/star_mending.h"

#include "plane/mesh/moves.h"
#include "plane/mesh/relocation.h"
#include "stars/star_mending.h"

namespace anistar {
namespace {

/// Trial places of each vertex that could mend a failure.
constexpr int n_candidates = 16;
constexpr double radius = .3;

class Mender {
public:
  Mender(Workspace &w, Seed seed)
      : mesh_(w.mesh), seed_(seed), relocation_(w), failures_(mesh_) {}

  /// Moves the vertex inside the ball of a failing cell, one of its own or one across
  /// its edges, such that fewer cells around fail. @returns whether it found a move.
  bool mend(Index cell, int round) {
    for (Index v : failures_.culprits(cell)) // none when an earlier move has mended it
      if (mesh_.feature[v] == Triangulation<2>::interior && move(v, round))
        return true;
    return false;
  }
  [[nodiscard]] std::vector<Index> take_changed() {
    return std::exchange(changed_, {});
  }
  [[nodiscard]] StarFailures<2> &failures() { return failures_; }

private:
  Triangulation<2> &mesh_;
  Seed seed_;
  Relocation relocation_;
  StarFailures<2> failures_;
  std::vector<Index> changed_;

  bool move(Index v, int round) {
    relocation_.gather(v);
    const Place from = relocation_.here();
    const StarScore before = relocation_.score();
    std::vector<Index> cells;
    for (HalfFacet h : relocation_.star())
      cells.push_back(h.cell());
    failures_.surround(cells);
    const int failing = failures_.count();
    CounterRandom random(seed_, Stream::mend, v, round);
    const EllipseSampler ellipse(from.vertex.M);
    for (int k = 0; k < n_candidates; ++k) {
      const Vector<2> x =
          from.vertex.x + ellipse.step(radius * (k + 1) / n_candidates, random);
      if (!may_move(mesh_, from.vertex.x, x, relocation_.star()))
        continue;
      relocation_.put(relocation_.at(x));
      const StarScore found = relocation_.score();
      if (found.keeps(before) && found.disagreeing <= before.disagreeing &&
          failures_.count_moved(v, failing) < failing) {
        failures_.forget();
        for (HalfFacet h : relocation_.star())
          changed_.push_back(h.cell());
        return true;
      }
      relocation_.put(from);
    }
    return false;
  }
};

} // namespace

StarCheck check_stars(Workspace &w, Monitor &monitor, Seed seed, int threads,
                      bool mend) {
  const Triangulation<2> &mesh = w.mesh;
  DelaunayBits found =
      delaunay_bits<2>({mesh.vertices, mesh.cells, mesh.neighbours, mesh.constraints},
                       threads, [&](double fraction) {
                         (void)monitor.look(fraction);
                         return true;
                       });
  StarCheck check;
  check.failures = failing_cells(mesh, found.bits).size();
  if (mend && check.failures > 0) {
    Mender mender(w, seed);
    check.moves = mend_failures(mesh, mender, monitor, found);
  }
  check.bits = std::move(found.bits);
  const CertifiedFractions fractions = certified_fractions(mesh, check.bits);
  check.simplex_ok = fractions.simplex_ok;
  check.star_ok = fractions.star_ok;
  return check;
}

} // namespace anistar
