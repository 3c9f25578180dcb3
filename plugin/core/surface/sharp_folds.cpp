#include "surface/sharp_folds.h"

#include "mesh/disjoint_sets.h"

#include <algorithm>
#include <numbers>

namespace anistar {
namespace {

/// A ridge goes on along a fold that turns by more than this many degrees, ...
constexpr double least_turn = 5;
/// ... and this many times as much as any other fold around: those of a surface that
/// is sampled badly differ by about as much.
constexpr double standing_out = 1.5;
/// Elsewhere it takes a chain of this many folds, or half as many that end at a ridge,
/// each turned by this fraction of the ridge angle and this many times as much as
/// others. Along a fillet or a leading edge of few facets neighbours do not differ as
/// much.
constexpr std::size_t shortest_chain = 4, worth_of_end = 2;
constexpr double weak_fraction = 1. / 3, far_standing_out = 2.5;
/// Two edges at a point are parts of one curve when they make a smaller angle (its
/// cosine).
const double straight_on = elementary::sine_cosine(std::numbers::pi / 4).cosine;

class Hysteresis {
public:
  Hysteresis(const SurfaceInput &input, std::span<const Fold> folds,
             std::span<const std::array<Index, 2>> others)
      : in_(input), folds_(folds), others_(others), is_sharp_(folds.size(), false) {}

  std::vector<bool> run() {
    if (in_.shape.is_faceted())
      return std::move(is_sharp_);
    const double strong = in_.shape.sharp_turn();
    std::vector<std::size_t> weak;
    for (std::size_t k = 0; k < folds_.size(); ++k)
      if (folds_[k].turn >= strong)
        start_at(k);
      else if (folds_[k].turn >= std::max(weak_fraction * strong, least_turn))
        weak.push_back(k);
    if (!weak.empty() || !ends_.empty()) {
      collect();
      std::erase_if(weak,
                    [&](std::size_t k) { return !stands_out(k, far_standing_out); });
      start_at_chains(std::move(weak));
      follow();
    }
    return std::move(is_sharp_);
  }

private:
  /// A ridge as it leaves through one of its two ends.
  struct End {
    std::size_t fold, side;
  };
  const SurfaceInput &in_;
  std::span<const Fold> folds_;
  std::span<const std::array<Index, 2>> others_;
  std::vector<bool> is_sharp_;
  std::vector<End> ends_;                            ///< still to be followed
  std::vector<std::vector<std::size_t>> folds_at_;   ///< a point
  std::vector<std::vector<Index>> others_at_;        ///< far ends of the other ridges
  std::vector<std::array<std::size_t, 3>> folds_of_; ///< a facet, the first n of them
  std::vector<std::size_t> n_folds_of_;

  [[nodiscard]] const Vector<3> &point(Index v) const { return in_.points[v]; }

  void start_at(std::size_t k) {
    is_sharp_[k] = true;
    ends_.push_back({k, 0});
    ends_.push_back({k, 1});
  }

  void start_at_chains(std::vector<std::size_t> weak) {
    DisjointSets chains(weak.size());
    for (std::size_t i = 0; i < weak.size(); ++i)
      for (std::size_t side : {0u, 1u}) {
        const auto &ends = folds_[weak[i]].ends;
        for (std::size_t next : folds_at_[ends[side]]) {
          const auto j = std::lower_bound(weak.begin(), weak.end(), next);
          if (j != weak.end() && *j == next &&
              continues(next, ends[1 - side], ends[side]))
            chains.join(i, j - weak.begin());
        }
      }
    std::vector<std::size_t> length(weak.size(), 0);
    for (std::size_t i = 0; i < weak.size(); ++i)
      for (Index v : folds_[weak[i]].ends)
        length[chains.root(i)] += is_joined(weak[i], v) ? 1 + 2 * worth_of_end : 1;
    std::erase_if(weak, [&, i = std::size_t{0}](std::size_t) mutable {
      return length[chains.root(i++)] < 2 * shortest_chain;
    });
    for (std::size_t k : weak)
      start_at(k);
  }

  void collect() {
    folds_at_.resize(in_.points.size());
    others_at_.resize(in_.points.size());
    folds_of_.resize(in_.facets.size());
    n_folds_of_.assign(in_.facets.size(), 0);
    for (std::size_t k = 0; k < folds_.size(); ++k) {
      for (Index v : folds_[k].ends)
        folds_at_[v].push_back(k);
      for (std::size_t f : folds_[k].facets)
        folds_of_[f][n_folds_of_[f]++] = k;
    }
    for (const auto &[a, b] : others_) {
      others_at_[a].push_back(b);
      others_at_[b].push_back(a);
    }
  }

  /// Every fold becomes sharp once, and has two ends.
  void follow() {
    while (!ends_.empty()) {
      const End end = ends_.back();
      ends_.pop_back();
      const Index from = folds_[end.fold].ends[1 - end.side],
                  at = folds_[end.fold].ends[end.side];
      if (goes_on(from, at) || !is_joined(end.fold, from))
        continue; // sharp folds by themselves, as a scan has many, lead nowhere
      std::size_t best = folds_.size();
      for (std::size_t k : folds_at_[at])
        if (is_straight_on(from, at, far_end(k, at)) && stands_out(k, standing_out) &&
            (best == folds_.size() || folds_[k].turn > folds_[best].turn))
          best = k;
      if (best == folds_.size())
        continue;
      is_sharp_[best] = true;
      ends_.push_back({best, folds_[best].ends[0] == at ? 1u : 0u});
    }
  }

  /// Whether a fold meets another ridge at this end.
  [[nodiscard]] bool is_joined(std::size_t k, Index v) const {
    const auto &here = folds_at_[v];
    return !others_at_[v].empty() ||
           std::any_of(here.begin(), here.end(), [&](std::size_t other) {
             return other != k && is_sharp_[other];
           });
  }

  [[nodiscard]] Index far_end(std::size_t k, Index v) const {
    return folds_[k].ends[folds_[k].ends[0] == v ? 1 : 0];
  }
  [[nodiscard]] bool is_straight_on(Index from, Index at, Index to) const {
    const Vector<3> u = point(at) - point(from), v = point(to) - point(at);
    return u.dot(v) >= straight_on * u.norm() * v.norm();
  }

  /// Whether a ridge that comes to a point leaves it again.
  [[nodiscard]] bool goes_on(Index from, Index at) const {
    const auto &others = others_at_[at];
    const auto &here = folds_at_[at];
    return std::any_of(others.begin(), others.end(),
                       [&](Index to) { return is_straight_on(from, at, to); }) ||
           std::any_of(here.begin(), here.end(), [&](std::size_t k) {
             return is_sharp_[k] && is_straight_on(from, at, far_end(k, at));
           });
  }

  /// Among the folds of the facets at its two ends, but for ridges and for those along
  /// which the ridge would go on.
  [[nodiscard]] bool stands_out(std::size_t k, double factor) const {
    const Fold &fold = folds_[k];
    if (fold.turn < least_turn)
      return false;
    for (std::size_t side : {0u, 1u}) {
      const Index at = fold.ends[side], from = fold.ends[1 - side];
      for (std::size_t near : folds_at_[at])
        for (std::size_t f : folds_[near].facets)
          for (std::size_t n = 0; n < n_folds_of_[f]; ++n) {
            const std::size_t other = folds_of_[f][n];
            if (other != k && fold.turn < factor * folds_[other].turn &&
                !is_sharp_[other] && !continues(other, from, at))
              return false;
          }
    }
    return true;
  }
  [[nodiscard]] bool continues(std::size_t other, Index from, Index at) const {
    const Fold &fold = folds_[other];
    return (fold.ends[0] == at || fold.ends[1] == at) &&
           is_straight_on(from, at, far_end(other, at));
  }
};

} // namespace

std::vector<bool> sharp_folds(const SurfaceInput &input, std::span<const Fold> folds,
                              std::span<const std::array<Index, 2>> others) {
  return Hysteresis(input, folds, others).run();
}

} // namespace anistar
