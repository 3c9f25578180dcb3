#pragma once
// The ellipsoid through the vertices of a cell, or of a facet and centred on a surface,
// in a metric, compared exactly with vertices and facets of a mesh.
//
// With y the offset from the first vertex, the power of a point is y^T M y - 2 g.y,
// where g makes it vanish at all vertices: negative inside, convex, and a polynomial in
// the stored doubles once multiplied by the determinant of the equations of g.

#include "base/bounded.h"
#include "base/predicates.h"
#include "certificate/surface/surface_facet.h"

#include <array>
#include <memory>
#include <variant>

namespace anistar {

template <std::size_t d> struct ExactBall;

/// One object to a thread.
template <std::size_t d> class Circumball {
public:
  /// @pre the simplex is positively oriented and outlives this object, as M does.
  Circumball(const SymmetricTensor<d> &M, const Simplex<d> &simplex);
  /// The M-surface ball of a facet. @pre the facet outlives this object, as M does.
  Circumball(const SymmetricTensor<d> &M, const SurfaceFacet<d> &facet);
  ~Circumball();
  Circumball(const Circumball &) = delete;
  Circumball &operator=(const Circumball &) = delete;

  /// Negative inside.
  [[nodiscard]] Bounded power(const Vector<d> &x) const;
  /// Where x lies, given its power.
  [[nodiscard]] Side side(const Vector<d> &x, const Bounded &power) const;

  /// Whether a facet meets the open ball, given the powers of its vertices.
  /// @pre no vertex of the facet lies inside.
  [[nodiscard]] bool meets(const std::array<const Vector<d> *, d> &facet,
                           const std::array<Bounded, d> &powers) const;

private:
  const SymmetricTensor<d> &M_;
  std::variant<const Simplex<d> *, const SurfaceFacet<d> *> through_;
  const Vector<d> &origin_;  ///< the first vertex
  Vector<d> gradient_;       ///< 2 g
  Vector<d> gradient_error_; ///< of each component; infinite where it is too flat

  mutable std::unique_ptr<ExactBall<d>> exact_; ///< made at the first doubt

  [[nodiscard]] ExactBall<d> &exact() const;
  [[nodiscard]] Bounded square(const Vector<d> &y) const;
  [[nodiscard]] bool leaves_inwards(const std::array<const Vector<d> *, d> &facet,
                                    std::size_t k) const;
  [[nodiscard]] Bounded slope(const Vector<d> &p, const Vector<d> &q) const;
  [[nodiscard]] bool meets_segment(const Vector<d> &p, const Vector<d> &q,
                                   const Bounded &at_p, const Bounded &at_q) const;
  [[nodiscard]] bool meets_triangle(const std::array<const Vector<d> *, d> &facet,
                                    const std::array<Bounded, d> &powers) const;
};

} // namespace anistar
