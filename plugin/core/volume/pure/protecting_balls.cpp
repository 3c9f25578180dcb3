#include "volume/pure/protecting_balls.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

namespace anistar {
namespace {

/// Radius of a ball, relative to the longer of the two edges at its centre: those of
/// two neighbours overlap by a fifth of their edge.
constexpr double radius_of_edge = .6;
/// No ball reaches further along an edge than this.
constexpr double farthest_along_edge = .9;
constexpr double least_overlap = 1.05;
/// Where balls do not fit, their curves are divided further, at most so often.
constexpr int most_divisions = 16;
constexpr double finer = 1.5;
/// All pairs of balls are compared.
constexpr std::size_t most_balls = 1 << 12;
/// Every site is compared with every star: no set of more ends in any useful time.
constexpr std::size_t most_edges = 1 << 20;
/// The edges at a corner differ in length by no more than this.
constexpr double corner_ratio = 1.25;
constexpr std::size_t least_of_closed = 3;

/// A ridge of the input between two corners, or a closed one.
struct Chain {
  std::vector<Index> vertices; ///< the first again at the end of a closed one
  std::vector<double> arc;     ///< length in the metric up to each of them
  Index curve = none;
  std::size_t n = 1; ///< edges that it is divided into

  [[nodiscard]] bool is_closed() const { return vertices.front() == vertices.back(); }
  [[nodiscard]] double edge() const { return arc.back() / double(n); }
};

/// As many edges as a length asks for, which may be more than an integer holds.
std::size_t n_edges(double wanted) {
  return wanted < double(most_edges) ? static_cast<std::size_t>(wanted) : most_edges;
}

/// The site at a part of the way along a chain.
Site site_on(const Volume &start, const Chain &chain, std::size_t k) {
  const double wanted = chain.arc.back() * double(k) / double(chain.n);
  const auto next =
      std::upper_bound(chain.arc.begin() + 1, chain.arc.end() - 1, wanted);
  const auto i = static_cast<std::size_t>(next - chain.arc.begin());
  const Index a = chain.vertices[i - 1], b = chain.vertices[i];
  const double part =
      (wanted - chain.arc[i - 1]) / std::max(chain.arc[i] - chain.arc[i - 1], 1e-300);
  const Vector<3> &x = start.mesh.vertex(a).x, &y = start.mesh.vertex(b).x;
  Site site{.dimension = 1, .lies_on = chain.curve};
  site.background = start.mesh.background_cell[a];
  site.vertex = start.background.vertex(
      start.surface.place(1, chain.curve, x + part * (y - x)), site.background);
  return site;
}

class Division {
public:
  Division(const Volume &start, const Run &run) : start_(start), run_(run) {
    gather_chains();
  }

  DividedRidges divide() {
    insist_on_room();
    return sites();
  }
  /// With balls, unless there would be too many.
  DividedRidges protect() {
    const std::vector<Chain> without_balls = chains_;
    std::optional<Protected> best = divide_evenly();
    if (!best) {
      chains_ = without_balls;
      return divide();
    }
    for (int round = 0; round < most_divisions && !best->too_long.empty(); ++round) {
      for (std::size_t c : best->too_long)
        chains_[c].n = n_edges(finer * double(chains_[c].n) + 1);
      std::optional<Protected> next = divide_evenly();
      if (!next || next->n_misfits >= best->n_misfits)
        break;
      best = std::move(next);
    }
    return std::move(best->ridges);
  }

private:
  /// Ridges with balls, and where these do not fit.
  struct Protected {
    DividedRidges ridges;
    std::size_t n_misfits = 0;
    std::set<std::size_t> too_long{}; ///< chains
  };
  const Volume &start_;
  const Run &run_;
  std::vector<Chain> chains_;
  std::vector<std::size_t> chain_of_edge_;

  [[nodiscard]] std::size_t n_edges_of_all() const {
    return std::accumulate(
        chains_.begin(), chains_.end(), std::size_t{0},
        [](std::size_t n, const Chain &chain) { return n + chain.n; });
  }
  /// Before anything is made of the chains.
  void insist_on_room() const {
    const std::size_t n = n_edges_of_all();
    if (n >= most_edges)
      throw BudgetSpent{};
    run_.monitor.insist(n);
  }

  void gather_chains() {
    std::vector<bool> seen(start_.ridges.edges().size(), false);
    const auto n = static_cast<Index>(start_.mesh.vertices.size());
    for (const bool from_corners : {true, false})
      for (Index v = 0; v < n; ++v) {
        const Index dimension = start_.feature(v);
        if (!start_.mesh.is_used(v) || dimension > 1 ||
            (dimension == Triangulation<3>::corner) != from_corners)
          continue;
        start_.ridges.around(v, [&](Index e, Index) {
          if (!seen[e])
            chains_.push_back(follow(v, e, seen));
        });
      }
    for (Chain &chain : chains_)
      chain.n = first_division(chain);
  }

  Chain follow(Index v, Index edge, std::vector<bool> &seen) const {
    Chain chain{.vertices = {v}, .arc = {0}, .curve = start_.ridges.at(edge).curve};
    while (edge != none) {
      seen[edge] = true;
      const auto &ends = start_.ridges.at(edge).ends;
      const Index from = chain.vertices.back(), to = ends[ends[0] == from ? 1 : 0];
      chain.vertices.push_back(to);
      chain.arc.push_back(chain.arc.back() + edge_length<3>(start_.mesh.vertex(from),
                                                            start_.mesh.vertex(to)));
      edge = none;
      if (start_.feature(to) == 1 && to != v)
        start_.ridges.around(to, [&](Index e, Index) {
          if (!seen[e])
            edge = e;
        });
    }
    return chain;
  }

  /// Into edges of about unit length that keep to the curve.
  [[nodiscard]] std::size_t first_division(Chain chain) const {
    chain.n = std::max<std::size_t>(chain.is_closed() ? least_of_closed : 1,
                                    n_edges(chain.arc.back() + .5));
    for (int k = 0; k < most_divisions && strays(chain); ++k)
      chain.n += (chain.n + 1) / 2;
    return chain.n;
  }
  [[nodiscard]] bool strays(const Chain &chain) const {
    if (start_.surface.is_flat(1, chain.curve))
      return false;
    for (std::size_t k = 0; k < chain.n; ++k) {
      run_.monitor.insist(chain.n);
      if (start_.surface.strays(1, chain.curve, site_on(start_, chain, k).vertex,
                                site_on(start_, chain, k + 1).vertex,
                                run_.hausdorff.curve))
        return true;
    }
    return false;
  }

  void even_out_corners() {
    std::vector<double> least(start_.mesh.vertices.size(),
                              std::numeric_limits<double>::infinity());
    for (int round = 0; round < most_divisions; ++round) {
      const auto ends = [](const Chain &chain) {
        return std::array{chain.vertices.front(), chain.vertices.back()};
      };
      for (const Chain &chain : chains_)
        for (Index v : ends(chain))
          least[v] = std::min(least[v], chain.edge());
      bool is_even = true;
      for (Chain &chain : chains_)
        for (Index v : ends(chain))
          if (const double bound = corner_ratio * least[v]; chain.edge() > bound) {
            chain.n = n_edges(chain.arc.back() / bound) + 1;
            is_even = false;
          }
      if (is_even)
        return;
    }
  }

  /// None where there would be too many balls.
  std::optional<Protected> divide_evenly() {
    even_out_corners();
    if (n_edges_of_all() > most_balls)
      return std::nullopt;
    insist_on_room();
    Protected found{.ridges = sites()};
    put_balls(found.ridges);
    find_misfits(found);
    return found;
  }
  DividedRidges sites() {
    DividedRidges out;
    chain_of_edge_.clear();
    std::vector<Index> at_vertex(start_.mesh.vertices.size(), none);
    const auto add_end = [&](Index v, Index curve) {
      if (at_vertex[v] == none) {
        at_vertex[v] = static_cast<Index>(out.sites.size());
        Site site{.vertex = start_.mesh.vertex(v),
                  .dimension = start_.feature(v),
                  .lies_on = start_.feature(v) == 1 ? curve : none,
                  .background = start_.mesh.background_cell[v]};
        out.sites.push_back(site);
      }
      return at_vertex[v];
    };
    for (std::size_t c = 0; c < chains_.size(); ++c) { // corners first
      (void)add_end(chains_[c].vertices.front(), chains_[c].curve);
      (void)add_end(chains_[c].vertices.back(), chains_[c].curve);
    }
    for (std::size_t c = 0; c < chains_.size(); ++c) {
      const Chain &chain = chains_[c];
      Index before = add_end(chain.vertices.front(), chain.curve);
      for (std::size_t k = 1; k <= chain.n; ++k) {
        run_.monitor.insist(out.sites.size());
        Index here = static_cast<Index>(out.sites.size());
        if (k == chain.n)
          here = add_end(chain.vertices.back(), chain.curve);
        else
          out.sites.push_back(site_on(start_, chain, k));
        out.edges.push_back({{before, here}, chain.curve, {none, none}});
        chain_of_edge_.push_back(c);
        before = here;
      }
    }
    return out;
  }
  static void put_balls(DividedRidges &ridges) {
    for (const RidgeEdge &edge : ridges.edges)
      for (std::size_t k = 0; k < 2; ++k) {
        Site &site = ridges.sites[edge.ends[k]];
        const double radius =
            radius_of_edge * distance(site, ridges.sites[edge.ends[1 - k]]);
        site.weight = std::max(site.weight, radius * radius);
      }
  }

  /// In the metric of the first.
  [[nodiscard]] static double distance(const Site &a, const Site &b) {
    return std::sqrt(quadratic<3>(a.vertex.M, b.vertex.x - a.vertex.x));
  }

  void find_misfits(Protected &found) const {
    const DividedRidges &ridges = found.ridges;
    std::set<std::array<Index, 2>> neighbours;
    std::vector<std::set<std::size_t>> chains_at(ridges.sites.size());
    for (std::size_t e = 0; e < ridges.edges.size(); ++e) {
      const auto [a, b] = ridges.edges[e].ends;
      neighbours.insert({std::min(a, b), std::max(a, b)});
      for (Index end : {a, b})
        chains_at[end].insert(chain_of_edge_[e]);
      if (!do_neighbours_fit(ridges.sites[a], ridges.sites[b])) {
        ++found.n_misfits;
        found.too_long.insert(chain_of_edge_[e]);
      }
    }
    const auto n = static_cast<Index>(ridges.sites.size());
    for (Index a = 0; a < n; ++a) {
      run_.monitor.insist(ridges.sites.size());
      for (Index b = 0; b < a; ++b)
        if (!neighbours.contains({b, a}) &&
            !are_apart(ridges.sites[a], ridges.sites[b],
                       do_meet(chains_at[a], chains_at[b]))) {
          ++found.n_misfits;
          found.too_long.insert(chains_at[a].begin(), chains_at[a].end());
          found.too_long.insert(chains_at[b].begin(), chains_at[b].end());
        }
    }
  }
  /// Whether one of these and one of those end at one corner.
  [[nodiscard]] bool do_meet(const std::set<std::size_t> &these,
                             const std::set<std::size_t> &those) const {
    for (std::size_t a : these)
      for (std::size_t b : those)
        for (Index v : {chains_[a].vertices.front(), chains_[a].vertices.back()})
          if (a != b &&
              (v == chains_[b].vertices.front() || v == chains_[b].vertices.back()))
            return true;
    return false;
  }
  [[nodiscard]] static bool do_neighbours_fit(const Site &a, const Site &b) {
    const double r = std::sqrt(a.weight), s = std::sqrt(b.weight);
    const double from_a = distance(a, b), from_b = distance(b, a);
    return r <= farthest_along_edge * from_a && s <= farthest_along_edge * from_b &&
           r + s >= least_overlap * std::max(from_a, from_b);
  }
  /// Whether two balls do not meet, or where their ridges do, hold the other's centre.
  [[nodiscard]] static bool are_apart(const Site &a, const Site &b, bool meet) {
    const double r = std::sqrt(a.weight), s = std::sqrt(b.weight);
    return (meet ? least_overlap * std::max(r, s) : r + s) <=
           std::min(distance(a, b), distance(b, a));
  }
};

} // namespace

DividedRidges divided_ridges(const Volume &start, const Run &run) {
  return Division(start, run).divide();
}

DividedRidges protected_ridges(const Volume &start, const Run &run) {
  return Division(start, run).protect();
}

} // namespace anistar
