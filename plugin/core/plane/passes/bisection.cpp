#include "plane/passes/bisection.h"

#include "plane/mesh/edits.h"
#include "plane/mesh/protecting_ball.h"
#include "plane/passes/repair.h"

namespace anistar {
namespace {

/// Every round halves what is flat: these are enough for a thousandth of the size.
constexpr int max_rounds = 16;
/// Rounds without a better worst cell, or less poor ones, before it ends.
constexpr int max_idle_rounds = 3;
/// Cells from one whose longest edge is its neighbour's too.
constexpr int longest_path = 64;
/// What is repaired in between by edges near to unit length.
constexpr QualityFloor unit_floor{.between_walls = .5, .elsewhere = .5};
/// Not more than one cell of so many may be poor, of few cells not more than these.
constexpr std::size_t cells_per_poor = 100, least_most_poor = 64;
/// The square of an edge that is long beside the longest one.
constexpr double long_part = .25;
constexpr int flip_cap = 60;
/// Of the radius of a protecting ball.
constexpr double ball_factor = .7;

class Bisection {
public:
  explicit Bisection(Workspace &w) : w_(w), mesh_(w.mesh) {}

  /// Splits a long wall of c, or else the edge where the path along longest edges ends.
  /// Between two walls new vertices inside would only make flatter cells.
  bool split(Index c) {
    const SymmetricTensor<2> &M = densest_metric(c);
    const double longest = square_of(longest_edge(c), M);
    for (std::size_t i = 0; i < 3; ++i)
      if (const HalfFacet wall(c, i);
          mesh_.constraint(wall) != none && square_of(wall, M) > long_part * longest)
        return w_.curve_edge(wall).ball == none ? split_at(wall) : shrink_ball(wall);
    HalfFacet edge = longest_edge(c);
    for (int k = 0; k < longest_path && mesh_.constraint(edge) == none; ++k) {
      const HalfFacet beyond = mesh_.opposite(edge), next = longest_edge(beyond.cell());
      if (next == beyond)
        break;
      edge = next;
    }
    return split_at(edge);
  }

private:
  Workspace &w_;
  Triangulation<2> &mesh_;
  std::optional<ProtectingBall> ball_; ///< once a leg across one is met

  /// Edges across a protecting ball are not split: the ball becomes smaller instead.
  bool shrink_ball(HalfFacet leg) {
    const CurveEdge &edge = w_.curve_edge(leg);
    const bool begins = mesh_.feature[edge.v0] == Triangulation<2>::corner;
    if (!ball_)
      ball_.emplace(w_);
    if (!ball_->gather(begins ? edge.v1 : edge.v0) || !ball_->resize(ball_factor))
      return false;
    if (!ball_->raises_quality()) {
      ball_->undo();
      return false;
    }
    ball_->commit();
    for (Index v : ball_->shell())
      w_.legaliser.push_star(v);
    w_.legaliser.run(flip_cap);
    return true;
  }

  [[nodiscard]] const SymmetricTensor<2> &densest_metric(Index c) const {
    const Cell<2> &v = mesh_.at(c);
    const auto *densest = &mesh_.vertex(v[0]);
    for (Index u : {v[1], v[2]})
      if (mesh_.vertex(u).weight < densest->weight)
        densest = &mesh_.vertex(u);
    return densest->M;
  }
  [[nodiscard]] double square_of(HalfFacet edge, const SymmetricTensor<2> &M) const {
    const auto [a, b] = mesh_.facet(edge);
    return quadratic<2>(M, mesh_.vertex(b).x - mesh_.vertex(a).x);
  }

  [[nodiscard]] HalfFacet longest_edge(Index c) const {
    const SymmetricTensor<2> &M = densest_metric(c);
    HalfFacet longest(c, 0);
    for (std::size_t i = 1; i < 3; ++i)
      if (const HalfFacet edge(c, i); square_of(edge, M) > square_of(longest, M))
        longest = edge;
    return longest;
  }

  bool split_at(HalfFacet edge) {
    if (split_edge(w_, edge) == none)
      return false;
    for (HalfFacet h : w_.cavity.star())
      for (std::size_t i = 0; i < 3; ++i)
        w_.legaliser.push(HalfFacet(h.cell(), i));
    w_.legaliser.run(flip_cap);
    return true;
  }
};

/// Whether rounds still lead on: the worst cell becomes better, or fewer are poor.
class Progress {
public:
  [[nodiscard]] bool has_ended(const Triangulation<2> &mesh,
                               std::span<const Index> poor) {
    double worst = 1;
    for (Index c : poor)
      worst = std::min(worst, quality_of(mesh, c));
    n_idle_ = worst > best_ || poor.size() < fewest_ ? 0 : n_idle_ + 1;
    best_ = std::max(best_, worst);
    fewest_ = std::min(fewest_, poor.size());
    return n_idle_ >= max_idle_rounds;
  }

private:
  double best_ = 0;
  std::size_t fewest_ = std::numeric_limits<std::size_t>::max();
  int n_idle_ = 0;
};

/// With more poor cells it is the metric that is so everywhere, and no splits help.
std::size_t most_poor(const Triangulation<2> &mesh) {
  return std::max(least_most_poor, mesh.cells.size() / cells_per_poor);
}

} // namespace

std::size_t bisect(Workspace &w, const Run &run, QualityFloor floor) {
  std::vector<Index> poor = poor_cells(w.mesh, floor, run.threads);
  if (poor.size() > most_poor(w.mesh)) {
    floor.elsewhere = floor.between_walls;
    poor = poor_cells(w.mesh, floor, run.threads);
  }
  Bisection bisection(w);
  Progress progress;
  std::size_t n_splits = 0;
  for (int round = 0; round < max_rounds && !poor.empty(); ++round) {
    (void)repair(w, run, {.floor = unit_floor});
    (void)repair(w, run, {.floor = floor, .at_any_length = true});
    poor = poor_cells(w.mesh, floor, run.threads);
    if (progress.has_ended(w.mesh, poor))
      break;
    for (Index c : poor)
      if (run.monitor.keep_going(w.mesh.vertices.size(), 0) && w.mesh.is_alive(c) &&
          !floor.is_met(w.mesh, c))
        n_splits += bisection.split(c);
    poor = poor_cells(w.mesh, floor, run.threads);
  }
  return n_splits;
}

} // namespace anistar
