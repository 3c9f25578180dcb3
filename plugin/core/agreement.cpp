#include "agreement.h"

#include "protecting_ball.h"

#include <utility>

namespace anistar {
namespace {

constexpr int max_passes = 10;
constexpr int n_candidates = 20;
/// Candidates lie within this metric distance; the radius grows from pass to pass.
constexpr double first_radius = .12, last_radius = .3;
constexpr int flip_cap = 20;

/// The walk on the plateau: only while this fraction of the edges disagrees, because it
/// would ruin the mesh on hopeless metrics, or this number, for small meshes.
constexpr double plateau_fraction = .002;
constexpr int always_few = 10;
constexpr int max_plateau_rounds = 60;
constexpr int n_plateau_candidates = 6;
constexpr double plateau_radius = .2;

constexpr int max_polish_sweeps = 4;
constexpr int n_polish_candidates = 10;
/// A polishing move must lower the excess by this much.
constexpr double least_gain = 1e-3;

/// Vertices to visit, each once, in the order in which they came.
class Worklist {
public:
  explicit Worklist(std::size_t n_vertices) : is_in_(n_vertices, false) {}

  void add(Index v) {
    if (!is_in_[static_cast<std::size_t>(v)]) {
      is_in_[static_cast<std::size_t>(v)] = true;
      items_.push_back(v);
    }
  }
  [[nodiscard]] std::vector<Index> take() {
    for (Index v : items_)
      is_in_[static_cast<std::size_t>(v)] = false;
    return std::exchange(items_, {});
  }
  [[nodiscard]] std::size_t size() const { return items_.size(); }

private:
  std::vector<Index> items_;
  std::vector<bool> is_in_;
};

class Agreement {
public:
  Agreement(Workspace &w, Legaliser &legaliser, Monitor &monitor, std::uint64_t seed)
      : w_(w), mesh_(w.mesh), legaliser_(legaliser), monitor_(monitor), seed_(seed),
        relocation_(w), ball_(w), work_(mesh_.vertices.size()) {}

  AgreementCounts run() {
    counts_.edges_before = scan();
    for (int pass = 0; pass < max_passes && work_.size() > 0; ++pass) {
      const double radius =
          first_radius + (last_radius - first_radius) * pass / (max_passes - 1);
      for (Index v : work_.take()) {
        if (!monitor_.keep_going(0, double(pass) / max_passes))
          return counts_;
        relocate(v, radius, pass);
        keep_if_disagreeing(v);
      }
    }
    walk_on_plateau();
    polish();
    counts_.edges_after = count_left();
    return counts_;
  }

private:
  Workspace &w_;
  Triangulation<2> &mesh_;
  Legaliser &legaliser_;
  Monitor &monitor_;
  std::uint64_t seed_;
  AgreementCounts counts_;
  Relocation relocation_;
  ProtectingBall ball_;
  Worklist work_;
  std::vector<Index> changed_;

  void list(HalfFacet edge) {
    const auto [a, b] = mesh_.facet(edge);
    for (Index v : {a, b, mesh_.apex(edge), mesh_.apex(mesh_.opposite(edge))})
      work_.add(v);
  }

  /// The one search for disagreeing edges.
  std::size_t scan() {
    std::size_t found = 0;
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
      for (std::size_t i = 0; i < 3; ++i) {
        const HalfFacet edge(static_cast<Index>(c), i), other = mesh_.opposite(edge);
        if (other.exists() && other.cell() > edge.cell() && disagrees(mesh_, edge)) {
          ++found;
          list(edge);
        }
      }
    return found;
  }

  void keep_if_disagreeing(Index v) {
    relocation_.gather(v);
    relocation_.for_each_edge([&](HalfFacet e) {
      if (disagrees(mesh_, e))
        list(e);
    });
  }

  bool relocate(Index v, double radius, int pass) {
    const Index feature = mesh_.feature[static_cast<std::size_t>(v)];
    relocation_.gather(v);
    if (feature == Triangulation<2>::corner || relocation_.count_disagreeing() == 0)
      return false;
    CounterRandom random(seed_, static_cast<std::uint64_t>(v),
                         static_cast<std::uint64_t>(pass));
    return feature == 1 ? relocate_on_curve(v, random, 1)
                        : relocate_freely(v, radius, random);
  }

  bool relocate_freely(Index v, double radius, CounterRandom &random) {
    const std::vector<HalfFacet> &star = relocation_.star();
    const Place from = relocation_.here();
    const Vector<2> x0 = from.vertex.x;
    const StarScore before = relocation_.score();
    const EllipseSampler ellipse(from.vertex.M);
    const Vector<2> pliant = x0 + pliant_displacement(mesh_, from.vertex, star);
    const Vector<2> odt = x0 + odt_displacement(mesh_, from.vertex, star);
    Place best = from;
    StarScore best_score = before;
    for (int k = 0; k < n_candidates; ++k) {
      Vector<2> x = k == 0 ? pliant : odt;
      if (k > 1)
        x = (k % 2 ? x0 : pliant) + ellipse.step(radius, random);
      if (!may_move(mesh_, x0, x, star))
        continue;
      const auto [place, found] = try_at(x, from);
      if (!found.keeps(before) || found.disagreeing >= before.disagreeing ||
          found.disagreeing > best_score.disagreeing ||
          (found.disagreeing == best_score.disagreeing &&
           found.excess >= best_score.excess))
        continue;
      best = place;
      best_score = found;
      if (found.disagreeing == 0 && k > 6)
        break;
    }
    if (best_score.disagreeing >= before.disagreeing)
      return false;
    relocation_.put(best);
    settle(v);
    return true;
  }

  std::pair<Place, StarScore> try_at(const Vector<2> &x, const Place &from) {
    ++counts_.trials;
    const Place place = relocation_.at(x);
    relocation_.put(place);
    const StarScore found = relocation_.score();
    relocation_.put(from);
    return {place, found};
  }

  /// @param least_drop of the number of disagreeing edges
  bool relocate_on_curve(Index v, CounterRandom &random, int least_drop) {
    const SlidingVertex on(w_, relocation_.star(), v);
    if (!on.can_slide())
      return resize_ball(v, random, least_drop);
    const Place from = relocation_.here();
    const StarScore before = relocation_.score();
    for (int k = 0; k < n_candidates; ++k) {
      const double r = 2 * last_radius * (random.uniform() - .5);
      const double dt = r * (r > 0 ? on.room_after() : on.room_before());
      if (!on.may_slide(dt) ||
          !may_move(mesh_, from.vertex.x, on.at(dt), relocation_.star()))
        continue;
      const auto [place, found] = try_at(on.at(dt), from);
      if (!found.keeps(before, part_kept_on_curve) ||
          found.disagreeing > before.disagreeing - least_drop)
        continue;
      relocation_.put(place);
      on.commit(dt);
      settle(v);
      return true;
    }
    return false;
  }

  /// Moves all vertices of the shell that v is on.
  bool resize_ball(Index v, CounterRandom &random, int least_drop) {
    if (!ball_.gather(v))
      return false;
    for (int k = 0; k < n_candidates; ++k) {
      const double factor = 1 + 2 * last_radius * (random.uniform() - .5);
      if (!ball_.resize(factor))
        continue;
      ++counts_.trials;
      if (!ball_.drops(least_drop)) {
        ball_.undo();
        continue;
      }
      ball_.commit();
      for (Index u : ball_.shell())
        settle(u);
      return true;
    }
    return false;
  }

  /// Flips around a moved vertex, and lists what disagrees where cells changed.
  void settle(Index v) {
    ++counts_.moves;
    changed_.clear();
    legaliser_.push_star(v);
    legaliser_.run(flip_cap, &changed_);
    for (Index c : changed_)
      for (std::size_t i = 0; i < 3; ++i)
        if (disagrees(mesh_, HalfFacet(c, i)))
          list(HalfFacet(c, i));
  }

  /// Random moves that do not raise the count, to leave local minima.
  void walk_on_plateau() {
    // four vertices are listed for an edge
    const double few =
        4 * std::max(static_cast<double>(always_few),
                     plateau_fraction * 1.5 * static_cast<double>(mesh_.n_cells()));
    for (int round = 0; round < max_plateau_rounds; ++round) {
      if (work_.size() == 0 || static_cast<double>(work_.size()) > few)
        return;
      for (Index v : round % 3 == 2 ? with_rings(work_.take()) : work_.take()) {
        if (!monitor_.keep_going(0, double(round) / max_plateau_rounds))
          return;
        if (!relocate(v, last_radius, max_passes + round))
          wander(v, round);
        keep_if_disagreeing(v);
      }
    }
  }

  [[nodiscard]] std::vector<Index> with_rings(const std::vector<Index> &vertices) {
    Worklist once(mesh_.vertices.size());
    for (Index v : vertices) {
      once.add(v);
      relocation_.gather(v);
      for (HalfFacet h : relocation_.star())
        for (Index u : mesh_.facet(h))
          once.add(u);
    }
    return once.take();
  }

  void wander(Index v, int round) {
    const Index feature = mesh_.feature[static_cast<std::size_t>(v)];
    if (feature == Triangulation<2>::corner)
      return;
    relocation_.gather(v);
    CounterRandom random(~seed_, static_cast<std::uint64_t>(v),
                         static_cast<std::uint64_t>(round));
    if (feature == 1) {
      (void)relocate_on_curve(v, random, 0);
      return;
    }
    const Place from = relocation_.here();
    const StarScore before = relocation_.score();
    const EllipseSampler ellipse(from.vertex.M);
    for (int k = 0; k < n_plateau_candidates; ++k) {
      const Vector<2> x = from.vertex.x + ellipse.step(plateau_radius, random);
      if (!may_move(mesh_, from.vertex.x, x, relocation_.star()))
        continue;
      const auto [place, found] = try_at(x, from);
      if (found.keeps(before) && found.disagreeing <= before.disagreeing) {
        relocation_.put(place);
        settle(v);
        return;
      }
    }
  }

  /// Takes back what agreement cost in lengths: moves that bring edges nearer to one
  /// and cause no new disagreement.
  void polish() {
    for (int sweep = 0; sweep < max_polish_sweeps; ++sweep) {
      std::size_t moved = 0;
      const auto n = static_cast<Index>(mesh_.vertices.size());
      for (Index v = 0; v < n && monitor_.keep_going(0, 1); ++v)
        if (mesh_.feature[static_cast<std::size_t>(v)] == Triangulation<2>::interior)
          moved += polish_vertex(v, sweep);
      if (moved == 0)
        return;
    }
  }

  bool polish_vertex(Index v, int sweep) {
    relocation_.gather(v);
    if (!relocation_.has_excess())
      return false;
    const Place from = relocation_.here();
    const Vector<2> x0 = from.vertex.x;
    const StarScore before = relocation_.score();
    const EllipseSampler ellipse(from.vertex.M);
    CounterRandom random(seed_ + 1, static_cast<std::uint64_t>(v),
                         static_cast<std::uint64_t>(sweep));
    const Vector<2> pliant =
        pliant_displacement(mesh_, from.vertex, relocation_.star());
    Place best = from;
    double best_excess = before.excess - least_gain;
    for (int k = 0; k < n_polish_candidates; ++k) {
      const Vector<2> step =
          k < 3 ? Vector<2>((1 << k) * pliant) : ellipse.step(plateau_radius, random);
      const Vector<2> x = x0 + step;
      if (!may_move(mesh_, x0, x, relocation_.star()))
        continue;
      const auto [place, found] = try_at(x, from);
      if (found.excess < best_excess && found.keeps(before) &&
          found.disagreeing <= before.disagreeing) {
        best = place;
        best_excess = found.excess;
      }
    }
    if (best_excess >= before.excess - least_gain)
      return false;
    relocation_.put(best);
    ++counts_.moves;
    return true;
  }

  /// The disagreeing edges at the vertices that are still listed, each once.
  [[nodiscard]] std::size_t count_left() {
    std::vector<std::pair<Index, std::size_t>> left;
    for (Index v : work_.take()) {
      relocation_.gather(v);
      relocation_.for_each_edge([&](HalfFacet e) {
        if (!disagrees(mesh_, e))
          return;
        const HalfFacet other = mesh_.opposite(e);
        const HalfFacet first = other.cell() < e.cell() ? other : e;
        left.emplace_back(first.cell(), first.facet());
      });
    }
    std::sort(left.begin(), left.end());
    return static_cast<std::size_t>(std::unique(left.begin(), left.end()) -
                                    left.begin());
  }
};

} // namespace

AgreementCounts agree(Workspace &w, Legaliser &legaliser, Monitor &monitor,
                      std::uint64_t seed) {
  return Agreement(w, legaliser, monitor, seed).run();
}

} // namespace anistar
