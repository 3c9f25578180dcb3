#include "plane/passes/repair.h"

#include "plane/mesh/edits.h"
#include "plane/mesh/vertex_trial.h"

#include <array>

namespace anistar {
namespace {

constexpr int max_rounds = 6;
/// An operation must raise the worst quality by this much: rounds end.
constexpr double least_gain = 1e-3;
/// Trial moves of a vertex: eight directions at these metric distances.
constexpr std::array radii{.4, .2, .1, .05};
constexpr int n_directions = 8;
/// No repair may leave an edge longer or shorter than these, unless it was so before.
constexpr double longest_edge = 1.6, shortest_edge = .5;
/// Edges of a poor cell beyond these are split or collapsed when that helps.
constexpr double split_above = 1.35, collapse_below = .75;

/// What a set of cells is judged by: an operation is good when it raises `worst`, and
/// does not push an edge out of bounds.
struct Score {
  double worst = 1;
  double longest = 0, shortest = std::numeric_limits<double>::infinity();

  void cell(const Vertex<2> &a, const Vertex<2> &b, const Vertex<2> &c) {
    worst = std::min(worst, quality(a, b, c));
  }
  void edge(const Vertex<2> &a, const Vertex<2> &b) {
    const double l = edge_length(a, b);
    longest = std::max(longest, l);
    shortest = std::min(shortest, l);
  }
  [[nodiscard]] bool improves(const Score &before, double least_length) const {
    return worst > before.worst + least_gain &&
           longest <= std::max(longest_edge, before.longest) &&
           shortest >= std::min(least_length, before.shortest);
  }
};

class Repair {
public:
  Repair(Workspace &w, const RepairRule &rule)
      : w_(w), mesh_(w.mesh), rule_(rule), trial_(w) {}

  /// Tries what raises the worst quality around cell c, simplest first.
  bool improve(Index c) {
    for (std::size_t i = 0; i < 3; ++i)
      if (swap(HalfFacet(c, i)))
        return true;
    const Cell<2> cell = mesh_.at(c);
    for (Index v : cell)
      if (move(v))
        return true;
    for (std::size_t i = 0; i < 3; ++i) {
      const double l = w_.length(HalfFacet(c, i));
      const auto [a, b] = mesh_.facet(HalfFacet(c, i));
      if ((rule_.at_any_length || l < collapse_below) &&
          (collapse(a, b) || collapse(b, a)))
        return true;
      if ((rule_.at_any_length || l > split_above) && split(HalfFacet(c, i)))
        return true;
    }
    return false;
  }

private:
  Workspace &w_;
  Triangulation<2> &mesh_;
  RepairRule rule_;
  PlaneTrial trial_;
  Collapse collapse_{};

  [[nodiscard]] bool improves(const Score &after, const Score &before) const {
    return after.improves(before, rule_.at_any_length ? 0 : shortest_edge);
  }

  [[nodiscard]] Score score_of(std::span<const Index> cells) const {
    Score score;
    for (Index c : cells) {
      score.worst = std::min(score.worst, quality_of(mesh_, c));
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [a, b] = mesh_.facet(HalfFacet(c, i));
        score.edge(mesh_.vertex(a), mesh_.vertex(b));
      }
    }
    return score;
  }

  /// The score of the star that would replace the bounded cavity.
  [[nodiscard]] Score score_after(const Vertex<2> &apex) const {
    Score score;
    for (HalfFacet h : w_.cavity.facets()) {
      const auto [ia, ib] = mesh_.facet(h);
      const Vertex<2> &a = mesh_.vertex(ia), &b = mesh_.vertex(ib);
      score.cell(apex, a, b);
      score.edge(apex, a);
      score.edge(apex, b);
      score.edge(a, b);
    }
    return score;
  }

  bool swap(HalfFacet edge) {
    if (!bound_swap(mesh_, edge, w_.cavity))
      return false;
    const Index apex = mesh_.apex(edge);
    if (!improves(score_after(mesh_.vertex(apex)), score_of(w_.cavity.cells())))
      return false;
    w_.cavity.fill(apex);
    return true;
  }

  bool collapse(Index v, Index target) {
    collapse_.vertex = v;
    collapse_.target = target;
    if (!bound_collapse(w_, collapse_) ||
        !improves(score_after(mesh_.vertex(target)), score_of(w_.cavity.cells())))
      return false;
    fill_collapse(w_, collapse_);
    return true;
  }

  /// Splits an edge when its two cells would be better off; only interior edges, whose
  /// halves are known before.
  bool split(HalfFacet edge) {
    const HalfFacet other = mesh_.opposite(edge);
    if (!other.exists() || mesh_.constraint(edge) != none)
      return false;
    const auto [a, b] = mesh_.facet(edge);
    Index hint = mesh_.background_cell[a];
    const Vertex<2> middle =
        w_.background.vertex(.5 * (mesh_.vertex(a).x + mesh_.vertex(b).x), hint);
    w_.cavity.clear();
    w_.cavity.add(edge.cell());
    w_.cavity.add(other.cell());
    w_.cavity.bound(none);
    if (!improves(score_after(middle), score_of(w_.cavity.cells())))
      return false;
    return split_edge(w_, edge) != none;
  }

  bool move(Index v) {
    if (mesh_.feature[v] != Triangulation<2>::interior)
      return false;
    trial_.gather(v);
    const Vertex<2> &from = trial_.from().vertex;
    const Score before = score_of_star(from);
    // unit steps of the metric: M^(-1/2) applied to directions of a circle
    const SymmetricTensor<2> step =
        matrix_function(from.M, [](double x) { return 1 / std::sqrt(x); });
    Place best = trial_.from();
    Score best_score = before;
    for (double radius : radii)
      for (int k = 0; k < n_directions; ++k) {
        const auto [sine, cosine] =
            elementary::sine_cosine(2 * std::numbers::pi * k / n_directions);
        const Vector<2> direction(radius * cosine, radius * sine);
        const Vector<2> x = from.x + product<2>(step, direction);
        if (!trial_.is_valid_at(x))
          continue;
        const Place place = trial_.at(x);
        const Score score = score_of_star(place.vertex);
        if (improves(score, best_score)) {
          best = place;
          best_score = score;
        }
      }
    if (!improves(best_score, before))
      return false;
    trial_.put(best);
    return true;
  }

  [[nodiscard]] Score score_of_star(const Vertex<2> &v) const {
    Score score;
    for (HalfFacet h : trial_.star()) {
      const auto [a, b] = mesh_.facet(h);
      score.cell(v, mesh_.vertex(a), mesh_.vertex(b));
      score.edge(v, mesh_.vertex(a));
    }
    return score;
  }
};

} // namespace

std::size_t repair(Workspace &w, const Run &run, const RepairRule &rule) {
  Repair operations(w, rule);
  std::size_t n_poor = 0;
  bool changed = true;
  for (int round = 0; round < max_rounds && changed; ++round) {
    const std::vector<Index> poor = poor_cells(w.mesh, rule.floor, run.threads);
    n_poor = poor.size();
    changed = false;
    for (Index c : poor)
      if (run.monitor.keep_going(w.mesh.vertices.size(), 0) && w.mesh.is_alive(c) &&
          !rule.floor.is_met(w.mesh, c))
        changed = operations.improve(c) || changed;
  }
  return n_poor;
}

} // namespace anistar
