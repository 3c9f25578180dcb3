#pragma once
// Trial places of a vertex and what its star is worth there.

#include "plane/mesh/disagreement.h"
#include "plane/mesh/workspace.h"

namespace anistar {

/// What a star is judged by when its vertex is moved for agreement.
struct StarScore {
  int disagreeing = 0; ///< see PlaneTrial::count_disagreeing
  double quality = 1;
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  double longest_at_end = 0; ///< in the metric of one end of an edge
  /// Sum over its edges of how far |ln length| is beyond a unit edge.
  double excess = 0;

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

/// A vertex of a mesh of triangles that is tried at other places before it stays at
/// one. Between gather(v) and the next one, everything is about v and its star.
class PlaneTrial {
public:
  explicit PlaneTrial(Workspace &w) : w_(w), mesh_(w.mesh) {}

  /// Which edges count when they disagree.
  enum class Edges { inner, all };
  void count(Edges edges) { edges_ = edges; }

  /// Takes up a vertex where it is.
  void gather(Index v) {
    v_ = v;
    star_of(mesh_, v, star_);
    from_ = {mesh_.vertex(v), mesh_.background_cell[v]};
  }
  [[nodiscard]] const std::vector<HalfFacet> &star() const { return star_; }
  /// Where it was when it was taken up.
  [[nodiscard]] const Place &from() const { return from_; }

  /// Whether every cell of the star is positive with the vertex at x, exactly.
  [[nodiscard]] bool is_valid_at(const Vector<2> &x) const;
  /// Whether they also keep some of their area.
  [[nodiscard]] bool may_move_to(const Vector<2> &x) const;
  /// x with the metric there.
  [[nodiscard]] Place at(const Vector<2> &x) const {
    Place out{{}, mesh_.background_cell[v_]};
    out.vertex = w_.background.vertex(x, out.background);
    return out;
  }
  void put(const Place &place) {
    mesh_.vertex(v_) = place.vertex;
    mesh_.background_cell[v_] = place.background;
  }
  void put_back() { put(from_); }

  /// What the star is worth as it is.
  [[nodiscard]] StarScore score() const;
  /// The edges of the star and of its link that disagree, those between two cells with
  /// a weight.
  [[nodiscard]] int count_disagreeing() const;
  /// Whether an edge of the star is not a unit edge: a quick look before score().
  [[nodiscard]] bool has_excess() const;
  /// What the star would be worth with the vertex at a place, to which it does not go.
  [[nodiscard]] StarScore score_at(const Place &place) {
    put(place);
    const StarScore found = score();
    put_back();
    return found;
  }

  /// visit(edge) for the edges of the star and of its link, each once.
  template <class Visit> void for_each_edge(Visit visit) const {
    for (HalfFacet h : star_) {
      visit(h);
      visit(HalfFacet(h.cell(), (h.facet() + 2) % 3));
    }
    const HalfFacet last = star_.back(), end(last.cell(), (last.facet() + 1) % 3);
    if (!mesh_.opposite(end).exists()) // on the boundary the star is open
      visit(end);
  }

private:
  Workspace &w_;
  Triangulation<2> &mesh_;
  Edges edges_ = Edges::all;
  Index v_ = none;
  Place from_{};
  std::vector<HalfFacet> star_;
};

} // namespace anistar
