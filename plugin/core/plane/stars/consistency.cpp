#include "plane/stars/consistency.h"

#include "base/ellipse_sampler.h"
#include "mesh/mesh_walk.h"
#include "plane/mesh/relocation.h"
#include "stars/bad_cells.h"
#include "stars/algorithm_2.h"

#include <cmath>
#include <utility>

namespace anistar {
namespace {

constexpr int max_rounds = 160;
/// Rounds without fewer failing cells after which the run has stalled.
constexpr int patience = 12;
/// Vertices are moved after every round when few cells fail, now and then when more do,
/// and never when nearly all do.
constexpr double few_failing = .02, many_failing = .3;
constexpr int rounds_between_moves = 4;
/// New vertices keep this distance from the others in their own metric (packing).
constexpr double separation = .4;
/// Encroached edges shorter than this are not split.
constexpr double shortest_split = .8;

/// More hits than any point that can be inserted has.
constexpr int not_insertable = std::numeric_limits<int>::max();

class Rounds {
public:
  Rounds(Workspace &w, const ConsistencyParameters &parameters, Seed seed,
         ConsistencyCounts &counts)
      : w_(w), mesh_(w.mesh), parameters_(parameters), seed_(seed), counts_(counts) {}

  /// One point for each bad cell that shares no vertex with one treated before, of the
  /// first rule that can place any. @returns that rule, `kept` when no rule can.
  Rule treat(const std::vector<BadCell<2>> &bad, int round) {
    std::vector<bool> touched(mesh_.vertices.size(), false);
    const std::size_t before = mesh_.vertices.size();
    Rule acting = Rule::kept;
    for (const BadCell<2> &item : bad) {
      if (item.rule != acting && mesh_.vertices.size() > before)
        break;
      acting = item.rule;
      if (mesh_.at(item.cell) != item.vertices ||
          std::any_of(item.vertices.begin(), item.vertices.end(),
                      [&](Index v) { return touched[v]; }))
        continue;
      for (Index v : item.vertices)
        touched[v] = true;
      insert_for(item, round);
    }
    return mesh_.vertices.size() > before ? acting : Rule::kept;
  }

private:
  Workspace &w_;
  Triangulation<2> &mesh_;
  const ConsistencyParameters &parameters_;
  Seed seed_;
  ConsistencyCounts &counts_;
  std::vector<std::pair<Index, HalfFacet>> ring_;

  void insert_for(const BadCell<2> &item, int round) {
    const SymmetricTensor<2> M = mesh_.vertex(item.star).M;
    const Simplex<2> s = mesh_.simplex(item.cell);
    const Circumcircle ball = circumcircle(M, s[0], s[1], s[2]);
    const EllipseSampler ellipse(M);
    CounterRandom random(seed_, Stream::pick, item.cell, round);
    // rule 1 inserts the circumcentre itself, the others a point of the picking region
    const bool is_centre_wanted = item.rule == Rule::size;
    int fewest = not_insertable;
    Vertex<2> best;
    Index best_cell = none, best_hint = none;
    HalfFacet wall;
    for (int k = 0; k < parameters_.candidates && fewest > 0; ++k) {
      if (is_centre_wanted && (fewest != not_insertable || wall.exists()))
        break;
      Vector<2> x = ball.centre;
      if (!is_centre_wanted || k > 0)
        x += ellipse.step(parameters_.delta * ball.radius, random);
      const Walk at = walk_to(mesh_, item.cell, x);
      if (at.cell == none) {
        wall = at.wall;
        continue;
      }
      Index hint = mesh_.background_cell[item.star];
      const Vertex<2> p = w_.background.vertex(x, hint);
      const HalfFacet near = encroached(p, at.cell);
      if (near.exists()) {
        wall = near;
        continue;
      }
      const int hits = hits_of(p, at.cell, parameters_.beta * ball.radius);
      if (hits < fewest) {
        fewest = hits;
        best = p;
        best_cell = at.cell;
        best_hint = hint;
      }
    }
    if (best_cell != none) {
      if (bound_insertion(best, best_cell)) {
        const Index v = mesh_.add_vertex(best, Triangulation<2>::interior, best_hint);
        w_.cavity.fill(v);
        counts_.add(item.rule);
      }
    } else if (wall.exists() && w_.length(wall) > shortest_split &&
               split_edge(w_, wall) != none) {
      ++counts_.boundary;
    }
  }

  /// A constrained edge of the cell in whose diametral ellipse p lies.
  [[nodiscard]] HalfFacet encroached(const Vertex<2> &p, Index cell) const {
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfFacet edge(cell, i);
      if (mesh_.constraint(edge) == none)
        continue;
      const auto [a, b] = mesh_.facet(edge);
      if (product<2>(p.M, mesh_.vertex(a).x - p.x).dot(mesh_.vertex(b).x - p.x) < 0)
        return edge;
    }
    return {};
  }

  /// The cavity of p: the cells around it whose M_p-ball contains it (Algorithm 1).
  /// @returns false when p does not see all of its boundary or is too near to a vertex.
  bool bound_insertion(const Vertex<2> &p, Index cell) {
    w_.cavity.clear();
    w_.cavity.add(cell);
    for (std::size_t k = 0; k < w_.cavity.cells().size(); ++k)
      for (std::size_t i = 0; i < 3; ++i) {
        const HalfFacet edge(w_.cavity.cells()[k], i), beyond = mesh_.opposite(edge);
        if (beyond.exists() && mesh_.constraint(edge) == none &&
            !w_.cavity.contains(beyond.cell()) &&
            in_metric_sphere<2>(p.M, mesh_.simplex(beyond.cell()), p.x) == Side::inside)
          w_.cavity.add(beyond.cell());
      }
    w_.cavity.bound(none);
    for (Index c : w_.cavity.cells())
      for (Index v : mesh_.at(c)) {
        const Vector<2> r = mesh_.vertex(v).x - p.x;
        const bool kept = std::any_of(w_.cavity.facets().begin(),
                                      w_.cavity.facets().end(), [&](HalfFacet h) {
                                        const auto [a, b] = mesh_.facet(h);
                                        return a == v || b == v;
                                      });
        if (!kept || quadratic<2>(p.M, r) < separation * separation)
          return false;
      }
    return w_.cavity.is_star_shaped(p.x);
  }

  /// Quasi-cospherical configurations that p would make, up to the given radius: edges
  /// of its star and of its link on which the four metrics would disagree.
  [[nodiscard]] int hits_of(const Vertex<2> &p, Index cell, double radius) {
    if (!bound_insertion(p, cell))
      return not_insertable;
    int hits = 0;
    ring_.clear(); // first vertex of each facet of the cavity -> the facet
    for (HalfFacet h : w_.cavity.facets())
      ring_.emplace_back(mesh_.facet(h)[0], h);
    std::sort(ring_.begin(), ring_.end(),
              [](const auto &x, const auto &y) { return x.first < y.first; });
    for (HalfFacet h : w_.cavity.facets()) {
      const auto [ia, ib] = mesh_.facet(h);
      const Vertex<2> &a = mesh_.vertex(ia), &b = mesh_.vertex(ib);
      if (circumcircle(p.M, p.x, a.x, b.x).radius > radius)
        continue;
      const HalfFacet beyond = mesh_.opposite(h);
      if (beyond.exists() && mesh_.constraint(h) == none)
        hits += metrics_disagree(a, b, p, mesh_.vertex(mesh_.apex(beyond)));
      const auto next =
          std::lower_bound(ring_.begin(), ring_.end(), ib,
                           [](const auto &item, Index v) { return item.first < v; });
      if (next != ring_.end() && next->first == ib) // cells (p, a, b) and (p, b, c)
        hits += metrics_disagree(p, b, mesh_.vertex(mesh_.facet(next->second)[1]), a);
    }
    return hits;
  }
};

[[nodiscard]] double failing_fraction(const std::vector<std::uint8_t> &bits) {
  const auto passing = std::count(bits.begin(), bits.end(), all_vertices<2>);
  return 1 - static_cast<double>(passing) / static_cast<double>(bits.size());
}

/// Whether vertices are moved after a round. While failures are everywhere, that helps
/// little for what it costs.
[[nodiscard]] bool is_moved_after(int round, double failing) {
  return failing < few_failing ||
         (failing < many_failing &&
          round % rounds_between_moves == rounds_between_moves - 1);
}

} // namespace

ConsistencyCounts refine_until_consistent(Workspace &w, Legaliser &legaliser,
                                          Monitor &monitor,
                                          const ConsistencyParameters &parameters,
                                          Seed seed, int threads, bool relocate,
                                          StarCheck &check) {
  ConsistencyCounts counts;
  Rounds rounds(w, parameters, seed, counts);
  RoundBounds bounds{max_rounds, patience, 0};
  MeshOnCurves best;
  StarCheck best_check;
  int since_best = 0;
  const auto start = [&] {
    best = w.on_curves;
    best_check = check;
    since_best = 0;
    bounds.most_vertices =
        (1 + parameters.max_growth) * static_cast<double>(w.mesh.vertices.size());
  };
  start();
  bool is_sizing = !relocate; // the pure mode starts from the boundary alone
  for (counts.rounds = 0;; ++counts.rounds) {
    // without moves rules 1 to 3 are also for cells that are consistent
    const std::vector<BadCell<2>> bad =
        bad_cells<2>(w.mesh, w.background, check.bits, parameters, !relocate);
    if (failing_fraction(check.bits) < failing_fraction(best_check.bits)) {
      best = w.on_curves;
      best_check = check;
      since_best = 0;
    }
    counts.stop = bounds.stop(bad.empty(), counts.rounds, since_best,
                              w.mesh.vertices.size(), monitor);
    if (!counts.stop.empty())
      break;
    // in the pure mode rules 1 to 3 end by packing, and only rule 4 can stall
    const Rule rule = rounds.treat(bad, counts.rounds);
    since_best += relocate || rule == Rule::inconsistency || rule == Rule::kept;
    const bool moving =
        relocate && is_moved_after(counts.rounds, failing_fraction(check.bits));
    const Seed round_seed{seed.value, static_cast<std::uint32_t>(counts.rounds) + 1};
    if (moving)
      (void)agree(w, legaliser, monitor, round_seed, threads);
    renumber(w, threads);
    check = check_stars(w, monitor, round_seed, threads, moving);
    is_sizing = is_sizing && rule == Rule::size;
    if (is_sizing)
      start(); // a mesh too coarse to be judged is no best one, and may grow
  }
  if (failing_fraction(check.bits) > failing_fraction(best_check.bits)) {
    w.on_curves = std::move(best);
    check = std::move(best_check);
  }
  counts.ln_gamma_p90 = ln_gamma_p90(w.mesh, check.bits);
  return counts;
}

} // namespace anistar
