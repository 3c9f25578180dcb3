#include "plane/passes/lengths.h"

#include "base/parallel.h"
#include "plane/mesh/edits.h"

namespace anistar {
namespace {

/// A collapse may leave no edge longer than this, nor a cell worse than that.
constexpr double longest_after_collapse = 1.5;
constexpr double worst_after_collapse = .2;
constexpr int flip_cap = 60;
/// Of the pass, when the splits begin.
constexpr double progress_at_splits = .5;

class LengthControl {
public:
  explicit LengthControl(Workspace &w) : w_(w) {}

  bool collapse_short(Index v, double shortest) {
    star_of(w_.mesh, v, star_);
    neighbours_.clear();
    double least = shortest;
    for (HalfFacet h : star_)
      for (Index u : w_.mesh.facet(h))
        if (std::find(neighbours_.begin(), neighbours_.end(), u) == neighbours_.end()) {
          neighbours_.push_back(u);
          least = std::min(least, edge_length(w_.mesh.vertex(v), w_.mesh.vertex(u)));
        }
    if (!(least < shortest))
      return false;
    Index best = none;
    double best_quality = worst_after_collapse;
    collapse_.vertex = v;
    for (Index u : neighbours_) {
      collapse_.target = u;
      if (!bound_collapse(w_, collapse_))
        continue;
      const double worst = quality_after(u);
      if (worst > best_quality) {
        best_quality = worst;
        best = u;
      }
    }
    if (best == none)
      return false;
    collapse_.target = best;
    (void)bound_collapse(w_, collapse_);
    fill_collapse(w_, collapse_);
    settle();
    return true;
  }

  bool split_long(HalfFacet edge, double longest) {
    if (w_.length(edge) <= longest || split_edge(w_, edge) == none)
      return false;
    settle();
    return true;
  }

private:
  Workspace &w_;
  std::vector<HalfFacet> star_;
  std::vector<Index> neighbours_;
  Collapse collapse_;

  void settle() {
    for (HalfFacet h : w_.cavity.star())
      for (std::size_t i = 0; i < 3; ++i)
        w_.legaliser.push(HalfFacet(h.cell(), i));
    w_.legaliser.run(flip_cap);
  }

  /// The worst cell that the bounded cavity would leave, 0 when an edge is too long.
  [[nodiscard]] double quality_after(Index apex) const {
    double worst = 1;
    for (HalfFacet h : w_.cavity.facets()) {
      const auto [a, b] = w_.mesh.facet(h);
      if (edge_length(w_.mesh.vertex(apex), w_.mesh.vertex(a)) > longest_after_collapse)
        return 0;
      worst = std::min(
          worst, quality(w_.mesh.vertex(apex), w_.mesh.vertex(a), w_.mesh.vertex(b)));
    }
    return worst;
  }
};

/// The edges whose length is wanted, each from one side.
template <class Wanted>
std::vector<HalfFacet> edges_of_length(const Workspace &w, int threads, Wanted wanted) {
  return parallel_search<HalfFacet>(
      w.mesh.cells.size(), threads, [&](std::size_t c, const auto &add) {
        if (!w.mesh.is_alive(static_cast<Index>(c)))
          return;
        for (std::size_t i = 0; i < 3; ++i) {
          const HalfFacet edge(static_cast<Index>(c), i), other = w.mesh.opposite(edge);
          if ((!other.exists() || other.cell() > edge.cell()) && wanted(w.length(edge)))
            add(edge);
        }
      });
}

} // namespace

LengthCounts control_lengths(Workspace &w, const Run &run, const LengthBounds &bounds) {
  LengthControl control(w);
  LengthCounts counts;
  const auto is_short = [&](double length) { return length < bounds.shortest; };
  const auto is_long = [&](double length) { return length > bounds.longest; };
  std::vector<Index> ends;
  for (HalfFacet edge : edges_of_length(w, run.threads, is_short))
    for (Index v : w.mesh.facet(edge))
      ends.push_back(v);
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (Index v : ends)
    if (run.monitor.keep_going(0, 0) && w.mesh.is_used(v) &&
        w.mesh.feature[v] != Triangulation<2>::corner)
      counts.collapses += control.collapse_short(v, bounds.shortest);
  std::vector<HalfFacet> edges = edges_of_length(w, run.threads, is_long);
  for (std::size_t k = 0;
       k < edges.size() &&
       run.monitor.keep_going(w.mesh.vertices.size(), progress_at_splits);
       ++k)
    if (w.mesh.is_alive(edges[k].cell()) &&
        control.split_long(edges[k], bounds.longest)) {
      ++counts.splits;
      for (HalfFacet h : w.cavity.star()) // the halves, when one was very long
        for (std::size_t i = 0; i < 3; ++i)
          if (is_long(w.length(HalfFacet(h.cell(), i))))
            edges.emplace_back(h.cell(), i);
    }
  return counts;
}

} // namespace anistar
