#pragma once
// A vertex of a volume mesh that is tried at other places, with the facets that it
// decides about.

#include "volume/mesh/vertex_trial.h"
#include "volume/stars/agreement_state.h"

#include <optional>

namespace anistar {

/// What a place of a vertex is worth to agreement.
struct PlaceScore {
  AgreementCost cost;
  double lengths = 0; ///< the penalty for edges that are far from unit
  double quality_min = 1;

  [[nodiscard]] double total() const { return cost.total() + lengths; }
};

/// What the qualities of a star must be.
struct ShapeDemand {
  double floor, sum;

  [[nodiscard]] bool is_met_by(const StarShapes &shapes) const {
    return shapes.minimum() >= floor && shapes.minimum() > 0 && shapes.sum() >= sum;
  }
};

class MovingVertex {
public:
  explicit MovingVertex(AgreementView &view)
      : view_(view), volume_(view.volume), trial_(volume_, view.hausdorff_number) {}

  /// Takes up v and its star. @returns false when v may not move or has too many cells.
  [[nodiscard]] bool gather_star(Index v);
  /// Takes up the edges and facets around it. @returns false when one of them leaves
  /// the slab: then v is put off.
  [[nodiscard]] bool gather_around();
  [[nodiscard]] bool gather(Index v) { return gather_star(v) && gather_around(); }
  /// Takes the vertex back to where it is in the mesh.
  void return_home() {
    (void)trial_.gather(v_, star_);
    take_home_normals();
  }

  // of the vertex where it is in the mesh
  [[nodiscard]] Index id() const { return v_; }
  [[nodiscard]] const Vertex<3> &home() const { return volume_.mesh.vertex(v_); }
  [[nodiscard]] std::span<const Index> star() const { return star_; }
  [[nodiscard]] double least_quality() const { return trial_.least_before(); }
  [[nodiscard]] double sum_of_qualities() const { return trial_.sum_before(); }
  [[nodiscard]] PlaceScore score_here() const;

  /// Tries x, or where x goes on the surface or ridge of the vertex. @returns whether
  /// all cells have a volume there.
  [[nodiscard]] bool place(const Vector<3> &x);
  /// What the place is worth; nothing as soon as the total is not below the limit or a
  /// cell is below the floor; nor where surfaces lose their shape. Facets do not fail
  /// in exchange for far violations.
  [[nodiscard]] std::optional<PlaceScore> evaluate(double floor, double limit);
  /// The same where the qualities there are to reach a floor and a sum.
  [[nodiscard]] bool place(const Vector<3> &x, const ShapeDemand &demand);
  /// Whether no more facets fail there, edges are no worse and surfaces keep their
  /// shape; facets and edges may come nearer to it.
  [[nodiscard]] bool disagrees_no_more(const PlaceScore &before);

  /// Remembers the place as the best one. @pre it was evaluated
  void remember();
  /// Moves the vertex of the mesh to the best place.
  void move_to_best();
  /// Moves it to where it is tried. @pre as for remember()
  void move_here() {
    remember();
    move_to_best();
  }

  /// A facet, or what is watched like one, with the trial vertex in the place of v.
  struct TestedFacet {
    HalfFacet at; ///< none of a far violation
    DecidingStar star;
    double here; ///< the margin where v is in the mesh
  };
  [[nodiscard]] std::span<const TestedFacet> facets() const { return facets_; }
  [[nodiscard]] std::span<const Index> ring() const { return ring_; }
  [[nodiscard]] const Vertex<3> &tried() const { return trial_.vertex(); }
  /// The qualities of the star with the vertex at x, in the metric that it has now.
  [[nodiscard]] const StarShapes &shapes_at(const Vector<3> &x) {
    return trial_.measure_at(x);
  }
  [[nodiscard]] std::size_t trials() const { return trials_; }

private:
  AgreementView &view_;
  Volume &volume_;
  VertexTrial trial_;
  Index v_ = none;
  std::vector<Index> star_, ring_; ///< its cells, and the vertices it has edges with
  std::vector<TestedFacet> facets_, safe_;
  std::vector<SurfaceNormals::Normal> normals_; ///< at the place that is tried
  std::vector<double> margins_;                 ///< there
  int failing_facets_ = 0;                      ///< where v is in the mesh
  TriedPlace best_;
  std::vector<SurfaceNormals::Normal> best_normals_;
  std::vector<double> best_margins_;
  std::size_t trials_ = 0;

  [[nodiscard]] bool put(const Vector<3> &x);
  [[nodiscard]] bool gather_facets(Index c, std::size_t at);
  void gather_far_violations();
  void add(HalfFacet at, const DecidingStar &star, double here);
  void put_trial_in(FacetStar &star) const;
  void put_trial_in(WallStar &star) const;
  void take_home_normals();
  void take_normals();
  [[nodiscard]] double length_penalty(const Vertex<3> &at) const;
};

} // namespace anistar
