#pragma once
// The eight rules of Algorithm 4 (RR-7712, section 7.1).

#include "base/run.h"
#include "stars/rules.h"
#include "volume/pure/star_set.h"

namespace anistar {

/// A facet or a cell of a restricted star, the first rule that it breaks there, and its
/// ball.
struct BadSimplex {
  Rule rule = Rule::kept;
  Index star = none;
  StarSimplex others{none, none, none}; ///< beside that of the star, `none` first
  Vector<3> centre = Vector<3>::Zero();
  double radius = 0;  ///< in the metric of the star
  Index patch = none; ///< that the ball of a facet is centred on
  Index edge = none;  ///< of a ridge, if it is one: two may have the same ends

  [[nodiscard]] bool is_edge() const { return edge != none; }
  [[nodiscard]] bool is_facet() const { return patch != none; }
  /// Whether this one is refined first: of one rule the larger.
  [[nodiscard]] bool precedes(const BadSimplex &other) const {
    if (rule != other.rule)
      return rule < other.rule;
    if (radius != other.radius)
      return radius > other.radius;
    return std::tie(star, others, edge) <
           std::tie(other.star, other.others, other.edge);
  }
};

/// Differs from the paper: rule 1 also asks that a facet stays as near to a curved
/// surface as the Hausdorff number says.
class Rules {
public:
  Rules(const StarSet &stars, const ConsistencyParameters &parameters,
        HausdorffNumbers hausdorff)
      : stars_(stars), parameters_(parameters), hausdorff_(hausdorff) {}

  /// Calls visit(simplex) for every one of the restricted stars of v that breaks a
  /// rule.
  template <class Visit> void each_bad(Index v, Visit visit) const {
    stars_.each_facet(v, [&](Index a, Index b, const SurfaceBall &ball) {
      if (const BadSimplex found = judge(v, a, b, ball); found.rule != Rule::kept)
        visit(found);
    });
    stars_.each_cell(v, [&](const LinkTriangle &t, const StarSimplex &others) {
      if (const BadSimplex found = judge(v, t, others); found.rule != Rule::kept)
        visit(found);
    });
  }
  [[nodiscard]] bool is_sliver(const Vertex<3> &v, const Simplex<3> &s) const;

private:
  const StarSet &stars_;
  const ConsistencyParameters &parameters_;
  HausdorffNumbers hausdorff_;

  [[nodiscard]] BadSimplex judge(Index v, Index a, Index b, const SurfaceBall &) const;
  [[nodiscard]] BadSimplex judge(Index v, const LinkTriangle &t,
                                 const StarSimplex &others) const;
  [[nodiscard]] double size_at(const Vector<3> &x, Index hint) const;
  [[nodiscard]] bool strays(Index v, Index a, Index b, const SurfaceBall &ball) const;
  [[nodiscard]] bool is_consistent(Index v, const LinkTriangle &t,
                                   const StarSimplex &others) const;
};

} // namespace anistar
