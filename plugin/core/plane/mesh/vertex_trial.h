#pragma once
// Trial places of a vertex and what its star is worth there.

#include "base/ellipse_sampler.h"
#include "plane/mesh/workspace.h"

namespace anistar {

/// Whether an edge is not Delaunay in the metric of one of the four vertices of its two
/// cells: the local test, necessary for a certificate (the in-sphere determinant is
/// linear in the metric, so one coefficient vector serves all four).
[[nodiscard]] bool disagrees(const Triangulation<2> &mesh, HalfFacet edge);

/// The same for the edge ab with c on its left and e on its right.
[[nodiscard]] bool metrics_disagree(const Vertex<2> &a, const Vertex<2> &b,
                                    const Vertex<2> &c, const Vertex<2> &e);

/// What a star is judged by when its vertex is moved for agreement.
struct StarScore {
  int disagreeing = 0; ///< edges of the star and of its link
  double quality = 1;
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  double longest_at_end = 0; ///< in the metric of one end of an edge
  double excess =
      0; ///< sum over its edges of how far |ln length| is beyond a unit edge

  /// No worse than the bounds of a relocation, or than this part of what it was.
  [[nodiscard]] bool keeps(const StarScore &before, double part = 1) const;
};

/// Where two walls leave room for flat cells only, every slide on a curve makes one of
/// them a little flatter: sliding vertices keep this part.
inline constexpr double part_kept_on_curve = .7;

/// A vertex with where its metric was found.
struct Place {
  Vertex<2> vertex;
  Index background;
};

/// Moves vertices on trial. Between gather(v) and the next one, everything is about
/// the star of v.
class Relocation {
public:
  explicit Relocation(Workspace &w) : w_(w), mesh_(w.mesh) {}

  void gather(Index v) {
    v_ = v;
    star_of(mesh_, v, star_);
  }
  [[nodiscard]] const std::vector<HalfFacet> &star() const { return star_; }
  [[nodiscard]] int count_disagreeing() const;
  [[nodiscard]] StarScore score() const;
  /// Whether an edge of the star is not a unit edge: a quick look before score().
  [[nodiscard]] bool has_excess() const;
  /// visit(edge) for the edges of the star and of its link, each once.
  template <class Visit> void for_each_edge(Visit visit) const {
    for (HalfFacet h : star_) {
      visit(h);
      visit(HalfFacet(h.cell(), (h.facet() + 2) % 3));
    }
  }

  [[nodiscard]] Place here() const {
    return {mesh_.vertex(v_), mesh_.background_cell[v_]};
  }
  void put(const Place &place) {
    mesh_.vertex(v_) = place.vertex;
    mesh_.background_cell[v_] = place.background;
  }
  [[nodiscard]] Place at(const Vector<2> &x) const {
    Place out{{}, mesh_.background_cell[v_]};
    out.vertex = w_.background.vertex(x, out.background);
    return out;
  }

private:
  Workspace &w_;
  Triangulation<2> &mesh_;
  Index v_ = none;
  std::vector<HalfFacet> star_;
};

} // namespace anistar
