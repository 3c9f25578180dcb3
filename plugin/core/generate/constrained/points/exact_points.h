#pragma once
// The points of a complex, those placed on lines between them, and exact predicates on
// both.
//
// A Steiner point (1 - t) a + t b is kept as it is defined, so that it lies on its edge
// and in every facet at that edge exactly; its rounded coordinates serve the filters.
// As t is a double, exact coordinates are sums of powers of two and need no division.

#include "base/predicates.h"
#include "generate/tetrahedralisation.h"

#include <memory>
#include <span>
#include <vector>

namespace anistar::generate {

/// How often the predicates were asked, and how often only exact arithmetic knew.
struct PredicateCounts {
  std::size_t asked = 0, exact = 0;
};

class ExactPoints {
public:
  explicit ExactPoints(std::span<const Vector<3>> given);
  ~ExactPoints();
  ExactPoints(ExactPoints &&) noexcept;

  /// Places a point, which lies on all planes that its ends share.
  /// @pre 0 < t < 1
  Index add(const SteinerPoint &point);
  /// Takes the last Steiner point away. @pre nothing depends on it
  void remove_last();
  /// Moves a Steiner point along its edge, and none that depends on it.
  void move(Index v, double t);
  /// Tells that v lies exactly on a plane, a number that the caller gives.
  void put_on_plane(Index v, Index plane);

  [[nodiscard]] Index size() const { return static_cast<Index>(rounded_.size()); }
  [[nodiscard]] Index n_given() const { return n_given_; }
  [[nodiscard]] const Vector<3> &rounded(Index v) const { return rounded_[v]; }
  /// Bounds how far each coordinate is from the rounded one; zero for given points.
  [[nodiscard]] double error(Index v) const { return error_[v]; }
  [[nodiscard]] const SteinerPoint &steiner(Index v) const {
    return steiner_[v - n_given_];
  }
  [[nodiscard]] std::span<const SteinerPoint> steiner_points() const {
    return steiner_;
  }
  [[nodiscard]] const PredicateCounts &counts() const { return counts_; }

  /// The sign of det [b - a, c - a, e - a].
  [[nodiscard]] Orientation orientation(Index a, Index b, Index c, Index e) const;
  /// The same for a place that is no point.
  [[nodiscard]] Orientation orientation(Index a, Index b, Index c,
                                        const Vector<3> &x) const;

  /// Whether p is in the circumsphere of a positively oriented cell, after a symbolic
  /// perturbation that leaves no five points on one sphere: that of Devillers and
  /// Teillaud, Perturbations for Delaunay and weighted Delaunay 3D triangulations,
  /// 2011, which CGAL's Delaunay triangulations use.
  [[nodiscard]] bool is_in_sphere(const Cell<3> &cell, Index p) const;

  /// Negative, zero or positive: lexicographic order of the coordinates.
  [[nodiscard]] int compare(Index a, Index b) const;
  /// Whether p lies on the line through a and b.
  [[nodiscard]] bool are_collinear(Index a, Index b, Index p) const;
  /// Whether a plane that was told contains all four.
  [[nodiscard]] bool share_plane(Index a, Index b, Index c, Index e) const;

  [[nodiscard]] double squared_distance(Index a, Index b) const {
    return (rounded_[a] - rounded_[b]).squaredNorm();
  }

private:
  struct Exact;

  Index n_given_;
  PerVertex<Vector<3>> rounded_;
  PerVertex<double> error_;
  PerVertex<std::vector<Index>> planes_; ///< of each point, sorted
  std::vector<SteinerPoint> steiner_;
  std::vector<std::unique_ptr<const Exact>> exact_; ///< of Steiner points
  mutable PredicateCounts counts_;

  /// Computes where a Steiner point is.
  void place(Index v);
  [[nodiscard]] Exact exact(Index v) const;
  [[nodiscard]] static Exact exact(const Vector<3> &x);
  [[nodiscard]] Side side_of_sphere(const Cell<3> &cell, Index p) const;
  [[nodiscard]] bool perturbed_is_in_sphere(const Cell<3> &cell, Index p) const;
  [[nodiscard]] Side exact_side_of_sphere(const Cell<3> &cell, Index p) const;
  [[nodiscard]] Orientation exact_orientation(const Exact &a, const Exact &b,
                                              const Exact &c, const Exact &e) const;
};

} // namespace anistar::generate
