#include "volume/pure/refinement.h"

#include <algorithm>
#include <map>
#include <queue>
#include <set>

namespace anistar {
namespace {

constexpr int most_insertions = 1 << 20;
/// Of stars that are consistent and no mesh.
constexpr int most_repairs = 40;
/// Of one simplex in one star, when no point is found for it. Every change around it is
/// an occasion to look again, as costly as an insertion: without this bound over forty
/// searches failed for each insertion on a torus.
constexpr int most_trials = 3;
/// Of the extent of the domain: at small angles the edges of ridges are halved for
/// ever.
constexpr double shortest_ridge_edge = 1e-6;

/// The first bad simplex of every star that has one, the first of all on top. What was
/// found before a star has changed is out of date, and left where it is.
class Agenda {
public:
  void put(const BadSimplex &bad) { queue_.push({bad, versions_[bad.star]}); }
  void renew(Index star) {
    if (std::cmp_greater_equal(star, versions_.size()))
      versions_.resize(star + 1, 0);
    ++versions_[star];
  }
  [[nodiscard]] std::optional<BadSimplex> first() {
    while (!queue_.empty() && queue_.top().version != versions_[queue_.top().bad.star])
      queue_.pop();
    return queue_.empty() ? std::nullopt : std::optional(queue_.top().bad);
  }

private:
  struct Entry {
    BadSimplex bad;
    std::uint32_t version;
    bool operator<(const Entry &other) const { return other.bad.precedes(bad); }
  };
  std::priority_queue<Entry> queue_;
  std::vector<std::uint32_t> versions_;
};

class Refinement {
public:
  Refinement(StarSet &stars, RidgeEdges &ridges, const Run &run,
             const ConsistencyParameters &parameters)
      : stars_(stars), ridges_(ridges), run_(run), parameters_(parameters),
        rules_(stars, parameters, run.hausdorff),
        pick_valid_(stars, rules_, parameters, run.monitor) {
    for (std::size_t v = 0; v < stars.size(); ++v)
      changed_.push_back(static_cast<Index>(v));
  }

  RefinedStarSet run() {
    MergedMesh merged;
    refine_all();
    for (int round = 0; counts_.stop == ConsistencyStop::consistent; ++round) {
      merged = merge(stars_, ridges_.edges());
      if (merged.obstacle == MergeObstacle::nothing)
        break;
      counts_.stop =
          run_.is_stopped() ? ConsistencyStop::max_seconds : ConsistencyStop::no_mesh;
      if (round < most_repairs && refine_at(merged.defects))
        refine_all();
    }
    return {counts_, std::move(merged)};
  }

private:
  using StuckSimplex = std::pair<Rule, StarSimplex>;
  StarSet &stars_;
  RidgeEdges &ridges_;
  const Run &run_;
  const ConsistencyParameters &parameters_;
  Rules rules_;
  PickValid pick_valid_;
  Agenda agenda_;
  ConsistencyCounts counts_;
  std::vector<Index> changed_;
  std::vector<std::set<StuckSimplex>>
      stuck_; ///< of every star, while it does not change
  std::vector<std::map<StuckSimplex, int>> trials_; ///< without a point, of every star
  std::size_t n_started_ = 0;                       ///< sites when sizes were in order
  bool is_starting_ = true;

  void refine_all() {
    do {
      look_at_changed();
      const std::optional<BadSimplex> bad = agenda_.first();
      note(bad);
      counts_.stop = stop(bad.has_value());
      if (counts_.stop == ConsistencyStop::none_yet && !refine(*bad))
        give_up(*bad);
    } while (counts_.stop == ConsistencyStop::none_yet);
  }
  /// Refines the largest surface facet at each of these sites that no insertion before
  /// has changed. @returns whether anything was inserted
  bool refine_at(std::vector<Index> sites) {
    std::sort(sites.begin(), sites.end());
    std::set<Index> changed;
    for (Index v : sites) {
      if (changed.contains(v))
        continue;
      const StarSet::SurfaceFacet t = largest_facet(v);
      if (!t.exists() || !insert_valid(bad_facet(t, Rule::facet_topology)))
        continue;
      changed.insert(changed_.begin(), changed_.end());
    }
    changed_.assign(changed.begin(), changed.end());
    return !changed.empty();
  }
  [[nodiscard]] StarSet::SurfaceFacet largest_facet(Index v) const {
    StarSet::SurfaceFacet found;
    stars_.each_facet(v, [&](Index a, Index b, const SurfaceBall &ball) {
      if (!found.exists() || ball.square_radius > found.ball.square_radius)
        found = {v, a, b, ball};
    });
    return found;
  }

  /// Growth counts from the first round in which sizes are in order.
  void note(const std::optional<BadSimplex> &bad) {
    if (is_starting_)
      n_started_ = stars_.size();
    is_starting_ = is_starting_ && bad && is_about_size(bad->rule);
  }

  void look_at_changed() {
    stuck_.resize(stars_.size());
    trials_.resize(stars_.size());
    for (Index v : changed_)
      agenda_.renew(v);
    for (Index v : changed_) {
      std::optional<BadSimplex> first;
      const auto see = [&](const BadSimplex &bad) {
        const StuckSimplex simplex{bad.rule, bad.others};
        if (is_hopeless(v, simplex))
          stuck_[v].insert(simplex);
        else if ((!first || bad.precedes(*first)) && !stuck_[v].contains(simplex))
          first = bad;
      };
      if (const Index edge = ridges_.missing(stars_, v); edge != none)
        see(bad_edge(edge, v));
      rules_.each_bad(v, see);
      if (first)
        agenda_.put(*first);
    }
    changed_.clear();
  }

  [[nodiscard]] ConsistencyStop stop(bool has_bad) {
    if (!has_bad && !is_stuck())
      return ConsistencyStop::consistent;
    if (run_.is_stopped()) // what was given up then may not be hopeless
      return ConsistencyStop::max_seconds;
    if (!has_bad)
      return ConsistencyStop::stalled;
    if (counts_.rounds == most_insertions)
      return ConsistencyStop::max_rounds;
    if (!run_.monitor.has_room(stars_.size()))
      return ConsistencyStop::max_vertices;
    if (static_cast<double>(stars_.size()) >
        (1 + parameters_.max_growth) * static_cast<double>(n_started_))
      return ConsistencyStop::max_growth;
    if (!run_.monitor.look(progress()))
      return ConsistencyStop::max_seconds;
    return ConsistencyStop::none_yet;
  }
  /// Of the growth that is allowed once sizes are in order.
  [[nodiscard]] double progress() const {
    const double grown = double(stars_.size()) / double(n_started_) - 1;
    return std::min(1., grown / parameters_.max_growth);
  }
  [[nodiscard]] bool is_hopeless(Index v, const StuckSimplex &simplex) const {
    const auto found = trials_[v].find(simplex);
    return found != trials_[v].end() && found->second >= most_trials;
  }
  [[nodiscard]] bool is_stuck() const {
    return std::any_of(stuck_.begin(), stuck_.end(),
                       [](const auto &of_star) { return !of_star.empty(); });
  }

  bool refine(const BadSimplex &bad) {
    return bad.is_edge()    ? split(bad.edge)
           : bad.is_facet() ? insert_valid(bad)
                            : insert_or_snap_valid(bad);
  }
  [[nodiscard]] BadSimplex bad_edge(Index edge, Index v) const {
    const auto &ends = ridges_.edges()[edge].ends;
    const Index w = ends[ends[0] == v ? 1 : 0];
    const Vertex<3> &a = stars_.site(v).vertex, &b = stars_.site(w).vertex;
    return {.rule = Rule::ridge_conformity,
            .star = v,
            .others = {none, none, w},
            .centre = .5 * (a.x + b.x),
            .radius = .5 * std::sqrt(quadratic<3>(a.M, b.x - a.x)),
            .edge = edge};
  }
  /// Balls cannot be split: sites outside of them leave their edges alone.
  bool split(Index edge) {
    const RidgeEdge &ridge = ridges_.edges()[edge];
    const Site &a = stars_.site(ridge.ends[0]), &b = stars_.site(ridge.ends[1]);
    const DomainOracle &domain = stars_.domain();
    const double extent = (domain.box().high - domain.box().low).maxCoeff();
    if (a.is_protected() ||
        (b.vertex.x - a.vertex.x).norm() < shortest_ridge_edge * extent)
      return false;
    Site site{.dimension = 1, .lies_on = ridge.curve, .background = a.background};
    site.vertex = domain.background().vertex(
        domain.shape().place(1, ridge.curve, .5 * (a.vertex.x + b.vertex.x)),
        site.background);
    ridges_.split(edge, static_cast<Index>(stars_.size()));
    return insert(site, Rule::ridge_conformity);
  }
  /// That a point would encroach upon, and that can be split instead.
  [[nodiscard]] Index encroached_edge(const Vector<3> &x) const {
    const Index edge = ridges_.encroached(stars_, x);
    return edge == none || stars_.site(ridges_.edges()[edge].ends[0]).is_protected()
               ? none
               : edge;
  }

  [[nodiscard]] PickValid::Picked pick_valid(const BadSimplex &bad) const {
    return pick_valid_(bad, CounterRandom(run_.seed, Stream::pick_site, bad.star,
                                          static_cast<std::uint32_t>(stars_.size())));
  }
  bool insert_valid(const BadSimplex &bad) {
    const PickValid::Picked picked = pick_valid(bad);
    if (!picked.site)
      return false;
    if (const Index edge = encroached_edge(picked.site->vertex.x); edge != none)
      return split(edge);
    return insert(*picked.site, bad.rule);
  }
  /// Algorithm 5.
  bool insert_or_snap_valid(const BadSimplex &bad) {
    const PickValid::Picked picked = pick_valid(bad);
    if (!picked.site)
      return false;
    if (const Index edge = encroached_edge(picked.site->vertex.x); edge != none)
      return split(edge);
    const StarSet::SurfaceFacet t = stars_.encroached(picked.site->vertex.x);
    if (!t.exists())
      return insert(*picked.site, bad.rule);
    return insert_valid(bad_facet(t, bad.rule));
  }
  [[nodiscard]] BadSimplex bad_facet(const StarSet::SurfaceFacet &t, Rule rule) const {
    return {.rule = rule,
            .star = t.star,
            .others = {none, std::min(t.a, t.b), std::max(t.a, t.b)},
            .centre = t.ball.centre,
            .radius = std::sqrt(std::max(0., t.ball.square_radius)),
            .patch = stars_.domain().facet(t.ball.facet).patch};
  }
  bool insert(const Site &site, Rule rule) {
    changed_ = stars_.insert(site);
    stuck_.resize(stars_.size());
    for (Index v : changed_)
      stuck_[v].clear();
    ++counts_.rounds;
    if (site.is_on_boundary() && !is_about_facets(rule))
      ++counts_.boundary;
    else
      counts_.add(rule);
    return true;
  }
  /// Until the star changes, or for good.
  void give_up(const BadSimplex &bad) {
    const StuckSimplex simplex{bad.rule, bad.others};
    stuck_[bad.star].insert(simplex);
    ++trials_[bad.star][simplex];
    changed_ = {bad.star};
  }
};

} // namespace

RefinedStarSet refine_star_set(StarSet &stars, RidgeEdges &ridges, const Run &run,
                               const ConsistencyParameters &parameters) {
  return Refinement(stars, ridges, run, parameters).run();
}

} // namespace anistar
