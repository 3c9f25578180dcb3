#include "agreement.h"

#include "moves.h"
#include "random.h"

#include <cmath>
#include <utility>

namespace anistar {
namespace {

constexpr int max_passes = 10;
constexpr int n_candidates = 20;
/// Candidates lie within this metric distance; the radius grows from pass to pass.
constexpr double first_radius = .12, last_radius = .3;
/// What a relocation must keep, unless it was worse before.
constexpr double quality_floor = .45;
constexpr double shortest = .55, longest = 1.7;
constexpr int flip_cap = 20;

/// The walk on the plateau: only while this fraction of the edges disagrees, because it
/// would ruin the mesh on hopeless metrics.
constexpr double plateau_fraction = .002;
constexpr int max_plateau_rounds = 60;
constexpr int n_plateau_candidates = 6;
constexpr double plateau_radius = .2;

constexpr int max_star_rounds = 4;
constexpr int n_star_candidates = 40;

/// Vertices to visit, each once, in the order in which they came.
class Worklist {
public:
  void add(Index v, std::size_t n_vertices) {
    if (is_in_.size() < n_vertices)
      is_in_.resize(n_vertices, false);
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
  [[nodiscard]] bool empty() const { return items_.empty(); }

private:
  std::vector<Index> items_;
  std::vector<bool> is_in_;
};

/// What a star is judged by.
struct StarScore {
  int disagreeing = 0;
  double quality = 1, shortest = std::numeric_limits<double>::infinity(), longest = 0;

  /// Not worse than the bounds, or than it was.
  [[nodiscard]] bool keeps(const StarScore &before) const {
    return quality >= std::min(quality_floor, before.quality) &&
           shortest >= std::min(anistar::shortest, before.shortest) &&
           longest <= std::max(anistar::longest, before.longest);
  }
};

class Agreement {
public:
  Agreement(Workspace &w, Legaliser &legaliser, Monitor &monitor, std::uint64_t seed)
      : w_(w), mesh_(w.mesh), legaliser_(legaliser), monitor_(monitor), seed_(seed) {}

  AgreementCounts run() {
    counts_.edges_before = scan();
    for (int pass = 0; pass < max_passes && !work_.empty(); ++pass) {
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
  Worklist work_;
  std::vector<HalfFacet> star_, around_;
  std::vector<Index> changed_;

  void list(HalfFacet edge) {
    const std::size_t n = mesh_.vertices.size();
    const auto [a, b] = mesh_.facet(edge);
    for (Index v : {a, b, mesh_.apex(edge), mesh_.apex(mesh_.opposite(edge))})
      work_.add(v, n);
  }

  /// The one search for disagreeing edges.
  std::size_t scan() {
    std::size_t found = 0;
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
      for (std::size_t i = 0; i < 3; ++i) {
        const HalfFacet edge(static_cast<Index>(c), i);
        if (!mesh_.is_alive(edge.cell()))
          continue;
        const HalfFacet other = mesh_.opposite(edge);
        if (other.exists() && other.cell() > edge.cell() && disagrees(mesh_, edge)) {
          ++found;
          list(edge);
        }
      }
    return found;
  }

  /// Edges of the star of v and of its link, each once.
  template <class Visit>
  void for_each_edge(std::span<const HalfFacet> star, Visit visit) const {
    for (HalfFacet h : star) {
      visit(h);
      visit(HalfFacet(h.cell(), (h.facet() + 2) % 3));
    }
  }

  [[nodiscard]] StarScore score(Index v) const {
    StarScore out;
    const Vertex<2> &vertex = mesh_.vertex(v);
    for_each_edge(star_, [&](HalfFacet e) { out.disagreeing += disagrees(mesh_, e); });
    for (HalfFacet h : star_) {
      const auto [a, b] = mesh_.facet(h);
      out.quality =
          std::min(out.quality, quality(vertex, mesh_.vertex(a), mesh_.vertex(b)));
      const double l = edge_length(vertex, mesh_.vertex(a));
      out.shortest = std::min(out.shortest, l);
      out.longest = std::max(out.longest, l);
    }
    return out;
  }

  [[nodiscard]] int count_disagreeing(std::span<const HalfFacet> star) const {
    int n = 0;
    for_each_edge(star, [&](HalfFacet e) { n += disagrees(mesh_, e); });
    return n;
  }

  void keep_if_disagreeing(Index v) {
    if (!mesh_.is_used(v))
      return;
    star_of(mesh_, v, star_);
    for_each_edge(star_, [&](HalfFacet e) {
      if (disagrees(mesh_, e))
        list(e);
    });
  }

  /// A vertex with where its metric was found.
  struct Place {
    Vertex<2> vertex;
    Index background;
  };
  [[nodiscard]] Place place_of(Index v) const {
    return {mesh_.vertex(v), mesh_.background_cell[static_cast<std::size_t>(v)]};
  }
  void put(Index v, const Place &place) {
    mesh_.vertex(v) = place.vertex;
    mesh_.background_cell[static_cast<std::size_t>(v)] = place.background;
  }
  [[nodiscard]] Place trial(const Vector<2> &x, Index background) const {
    Place out{{}, background};
    out.vertex = w_.background.vertex(x, out.background);
    return out;
  }

  /// A random point of the ellipse of the given metric radius.
  [[nodiscard]] static Vector<2> random_step(const SymmetricTensor<2> &inverse_root,
                                             double radius, CounterRandom &random) {
    const double r = radius * std::sqrt(random.uniform());
    const double angle = 2 * std::numbers::pi * random.uniform();
    return product<2>(inverse_root,
                      Vector<2>(r * std::cos(angle), r * std::sin(angle)));
  }

  static SymmetricTensor<2> inverse_root(const SymmetricTensor<2> &M) {
    return matrix_function(M, [](double x) { return 1 / std::sqrt(x); });
  }

  bool relocate(Index v, double radius, int pass) {
    const Index feature = mesh_.feature[static_cast<std::size_t>(v)];
    if (!mesh_.is_used(v) || feature == Triangulation<2>::corner)
      return false;
    star_of(mesh_, v, star_);
    if (count_disagreeing(star_) == 0)
      return false;
    if (feature == 1)
      return relocate_on_curve(v, pass);
    const Place from = place_of(v);
    const StarScore before = score(v);
    CounterRandom random(seed_, static_cast<std::uint64_t>(v),
                         static_cast<std::uint64_t>(pass));
    const SymmetricTensor<2> root = inverse_root(from.vertex.M);
    const Vector<2> pliant =
        from.vertex.x + pliant_displacement(mesh_, from.vertex, star_);
    const Vector<2> odt = from.vertex.x + odt_displacement(mesh_, from.vertex, star_);
    Place best = from;
    StarScore best_score = before;
    for (int k = 0; k < n_candidates; ++k) {
      Vector<2> x = k == 0 ? pliant : odt;
      if (k > 1)
        x = (k % 2 ? from.vertex.x : pliant) + random_step(root, radius, random);
      if (!may_move(mesh_, from.vertex.x, x, star_))
        continue;
      ++counts_.trials;
      const Place place = trial(x, from.background);
      put(v, place);
      const StarScore found = score(v);
      put(v, from);
      if (!found.keeps(before) || found.disagreeing >= before.disagreeing ||
          found.disagreeing > best_score.disagreeing ||
          (found.disagreeing == best_score.disagreeing &&
           found.quality <= best_score.quality))
        continue;
      best = place;
      best_score = found;
      if (found.disagreeing == 0 && k > 6)
        break;
    }
    if (best_score.disagreeing >= before.disagreeing)
      return false;
    put(v, best);
    settle(v);
    return true;
  }

  bool relocate_on_curve(Index v, int pass) {
    const SlidingVertex on(w_, star_, v);
    if (!on.can_slide())
      return false;
    const Place from = place_of(v);
    const StarScore before = score(v);
    CounterRandom random(seed_, static_cast<std::uint64_t>(v),
                         static_cast<std::uint64_t>(pass));
    for (int k = 0; k < n_candidates; ++k) {
      const double r = .6 * random.uniform() - .3;
      const double dt = r * (r > 0 ? on.room_after() : on.room_before());
      if (!on.may_slide(dt) || !may_move(mesh_, from.vertex.x, on.at(dt), star_))
        continue;
      ++counts_.trials;
      put(v, trial(on.at(dt), from.background));
      const StarScore found = score(v);
      if (found.keeps(before) && found.disagreeing < before.disagreeing) {
        on.commit(dt);
        settle(v);
        return true;
      }
      put(v, from);
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
    const double edges = 1.5 * static_cast<double>(mesh_.n_cells());
    for (int round = 0; round < max_plateau_rounds && !work_.empty(); ++round) {
      std::vector<Index> visit = work_.take();
      if (static_cast<double>(visit.size()) > 4 * plateau_fraction * edges) {
        for (Index v : visit)
          work_.add(v, mesh_.vertices.size());
        return;
      }
      if (round % 3 == 2)
        add_rings(visit);
      for (Index v : visit) {
        if (!monitor_.keep_going(0, double(round) / max_plateau_rounds))
          return;
        if (!mesh_.is_used(v))
          continue;
        if (!relocate(v, last_radius, max_passes + round))
          wander(v, round);
        keep_if_disagreeing(v);
      }
    }
  }

  void add_rings(std::vector<Index> &visit) {
    Worklist once;
    for (Index v : visit)
      once.add(v, mesh_.vertices.size());
    for (Index v : visit)
      if (mesh_.is_used(v)) {
        star_of(mesh_, v, star_);
        for (HalfFacet h : star_)
          for (Index u : mesh_.facet(h))
            once.add(u, mesh_.vertices.size());
      }
    visit = once.take();
  }

  void wander(Index v, int round) {
    if (mesh_.feature[static_cast<std::size_t>(v)] != Triangulation<2>::interior)
      return;
    star_of(mesh_, v, star_);
    const Place from = place_of(v);
    const StarScore before = score(v);
    CounterRandom random(~seed_, static_cast<std::uint64_t>(v),
                         static_cast<std::uint64_t>(round));
    const SymmetricTensor<2> root = inverse_root(from.vertex.M);
    for (int k = 0; k < n_plateau_candidates; ++k) {
      const Vector<2> x = from.vertex.x + random_step(root, plateau_radius, random);
      if (!may_move(mesh_, from.vertex.x, x, star_))
        continue;
      ++counts_.trials;
      put(v, trial(x, from.background));
      const StarScore found = score(v);
      if (found.keeps(before) && found.disagreeing <= before.disagreeing) {
        settle(v);
        return;
      }
      put(v, from);
    }
  }

  [[nodiscard]] std::size_t count_left() {
    std::vector<HalfFacet> left;
    for (Index v : work_.take())
      if (mesh_.is_used(v)) {
        star_of(mesh_, v, star_);
        for_each_edge(star_, [&](HalfFacet e) {
          if (disagrees(mesh_, e))
            left.push_back(std::max(e, mesh_.opposite(e), [](HalfFacet a, HalfFacet b) {
              return a.cell() < b.cell();
            }));
        });
      }
    const auto order = [](HalfFacet a, HalfFacet b) {
      return std::pair(a.cell(), a.facet()) < std::pair(b.cell(), b.facet());
    };
    std::sort(left.begin(), left.end(), order);
    return static_cast<std::size_t>(std::unique(left.begin(), left.end()) -
                                    left.begin());
  }
};

} // namespace

bool disagrees(const Triangulation<2> &mesh, HalfFacet edge) {
  const HalfFacet other = mesh.opposite(edge);
  if (!other.exists() || mesh.constraint(edge) != none)
    return false;
  const auto [ia, ib] = mesh.facet(edge);
  const Vertex<2> &a = mesh.vertex(ia), &b = mesh.vertex(ib);
  const Vertex<2> &c = mesh.vertex(mesh.apex(edge)), &e = mesh.vertex(mesh.apex(other));
  // det = <M, K> with K = sum_i cof_i x_i x_i^T, and <|M|, S> bounds its terms
  const Vector<2> x[3] = {a.x - e.x, b.x - e.x, c.x - e.x};
  double K[3] = {0, 0, 0}, S[3] = {0, 0, 0};
  for (int i = 0; i < 3; ++i) {
    const Vector<2> &p = x[(i + 1) % 3], &q = x[(i + 2) % 3], &u = x[i];
    const double pq = p[0] * q[1], qp = p[1] * q[0];
    const double minor = pq - qp, size = std::abs(pq) + std::abs(qp);
    const double xx = u[0] * u[0], xy = 2 * u[0] * u[1], yy = u[1] * u[1];
    K[0] += minor * xx;
    K[1] += minor * xy;
    K[2] += minor * yy;
    S[0] += size * xx;
    S[1] += size * std::abs(xy);
    S[2] += size * yy;
  }
  for (const Vertex<2> *v : {&a, &b, &c, &e}) {
    const auto &M = v->M.entries;
    const double det = M[0] * K[0] + M[1] * K[1] + M[2] * K[2];
    const double bound =
        detail::sphere_bound_2 * (M[0] * S[0] + std::abs(M[1]) * S[1] + M[2] * S[2]);
    if (det > bound)
      return true;
    if (det >= -bound && in_metric_sphere(v->M, a.x, b.x, c.x, e.x) == Side::inside)
      return true;
  }
  return false;
}

AgreementCounts agree(Workspace &w, Legaliser &legaliser, Monitor &monitor,
                      std::uint64_t seed) {
  return Agreement(w, legaliser, monitor, seed).run();
}

} // namespace anistar
