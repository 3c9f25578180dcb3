#pragma once
// A vertex of a volume mesh that is tried at other places before it moves to one.
//
// gather(v, star), then for one place after another: place(x), ask whether it is valid
// (is_positive, keeps_surfaces), take_metric(), measure(); and commit() where the
// caller likes what is measured. Nothing in the mesh changes before that.

#include "base/random.h"
#include "volume/mesh/volume.h"

namespace anistar {

/// L^T x, for the lower factor L of a metric: a step in coordinates in which the metric
/// is the identity.
[[nodiscard]] inline Vector<3> in_metric(const Matrix<3> &L, const Vector<3> &x) {
  return {L(0, 0) * x[0] + L(1, 0) * x[1] + L(2, 0) * x[2],
          L(1, 1) * x[1] + L(2, 1) * x[2], L(2, 2) * x[2]};
}
/// x with L^T x = y: a step in space.
[[nodiscard]] Vector<3> in_space(const Matrix<3> &L, const Vector<3> &y);
/// Uniform in the unit ball.
[[nodiscard]] Vector<3> random_in_ball(CounterRandom &random);

/// The mean of the places where each facet of the star of v would have its ideal apex,
/// weighted towards the worst cells, as a step in coordinates of the metric.
/// @param seen(step) gives a step in space in these coordinates, as in_metric does
/// @param smallest_facet facets of less, twice the area, have no direction
template <class Seen>
[[nodiscard]] Vector<3> ideal_step(const Volume &volume, Index v,
                                   std::span<const Index> star, Seen seen,
                                   double smallest_facet = 0) {
  /// Height of the regular tetrahedron of unit edges.
  constexpr double unit_height = .816496580927726;
  /// What bounds the weight of a flat cell, as a square of a quality.
  constexpr double flat = .01;
  const Triangulation<3> &mesh = volume.mesh;
  const Vector<3> &here = mesh.vertex(v).x;
  Vector<3> step = Vector<3>::Zero();
  double weight = 0;
  for (Index c : star) {
    const Facet<3> t = facet_of<3>(mesh.at(c), mesh.local_index(c, v));
    const Vector<3> a = seen(mesh.vertex(t[0]).x - here),
                    b = seen(mesh.vertex(t[1]).x - here),
                    d = seen(mesh.vertex(t[2]).x - here);
    const Vector<3> normal = (b - a).cross(d - a);
    const double size = normal.norm();
    if (!(size > smallest_facet))
      continue;
    const double q = volume.quality_of(c), w = 1 / (q * q + flat);
    step += w * ((a + b + d) / 3 + (unit_height / size) * normal);
    weight += w;
  }
  return weight > 0 ? Vector<3>(step / weight) : step;
}

/// A place that was tried: the vertex there, where its metric was found, and the shapes
/// of its cells.
struct TriedPlace {
  Vertex<3> vertex{};
  Index background_cell = none;
  std::vector<float> qualities;
};

class VertexTrial {
public:
  /// @param hausdorff_number of curved surfaces, relative to an edge
  VertexTrial(Volume &volume, double hausdorff_number)
      : volume_(volume), hausdorff_number_(hausdorff_number) {}

  /// Takes up a vertex. @param star its cells, which stay as they are
  /// @returns false when it has too many of them
  [[nodiscard]] bool gather(Index v, std::span<const Index> star);
  /// The worst of the cells as they are, and the sum of their qualities.
  [[nodiscard]] double least_before() const { return least_before_; }
  [[nodiscard]] double sum_before() const { return sum_before_; }

  /// Tries x, or where x goes on the surface or ridge of the vertex.
  void place(const Vector<3> &x);
  /// Of the surface that the vertex lies on, at its place or close to it, of unit
  /// length; zero where nothing tells.
  [[nodiscard]] const Vector<3> &surface_normal() const { return normal_; }
  /// Whether all cells have a volume there, up to round-off.
  [[nodiscard]] bool is_positive() const { return shapes_.are_positive(at_.x); }
  /// Whether the facets of surfaces keep their side, and stay near curved ones.
  [[nodiscard]] bool keeps_surfaces() const;
  /// Finds the metric there.
  void take_metric();
  /// Finds the shapes of the cells there. @pre the metric was taken
  const StarShapes &measure();
  /// The same with the vertex at x, in the metric that it has where it is tried.
  const StarShapes &measure_at(const Vector<3> &x);
  /// Where it is tried; the address stays the same.
  [[nodiscard]] const Vertex<3> &vertex() const { return at_; }

  /// The place that is tried now. @pre the shapes were measured
  void remember(TriedPlace &place) const;

  /// Moves the vertex of the mesh there. @pre the shapes were measured
  void commit();
  /// The same for a place that was remembered.
  void commit(const TriedPlace &place);

private:
  Volume &volume_;
  double hausdorff_number_;
  Index v_ = none;
  std::span<const Index> star_;
  StarShapes shapes_;
  double least_before_ = 1, sum_before_ = 0;
  Vertex<3> at_{};
  Vector<3> normal_ = Vector<3>::Zero();
  Index background_cell_ = none; ///< where its metric was found
};

} // namespace anistar
