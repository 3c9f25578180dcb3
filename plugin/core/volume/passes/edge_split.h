#pragma once
// The split of one edge of a volume mesh, on the curve or surface that it lies on.

#include "base/run.h"
#include "volume/mesh/cavity_operator.h"
#include "volume/mesh/shell.h"

namespace anistar {

struct NewVertexRule {
  double closest = 0;         ///< nearest it may come to the others around the edge
  bool follows_curve = false; ///< only where the halves are nearer to a curved feature
};

class EdgeSplit {
public:
  EdgeSplit(Volume &volume, CavityOperator &op, const Run &run)
      : volume_(volume), operator_(op), run_(run) {}

  /// Splits the edge ab of a cell; @returns whether it did.
  [[nodiscard]] bool split(Index cell, Index a, Index b, const NewVertexRule &rule,
                           const Acceptance &acceptance);
  /// Whether one had to be left out for want of vertices.
  [[nodiscard]] bool is_full() const { return is_full_; }

private:
  Volume &volume_;
  CavityOperator &operator_;
  const Run &run_;
  bool is_full_ = false;
  Shell shell_;
  std::vector<Index> cavity_;

  [[nodiscard]] bool comes_nearer(const EdgeFeature &feature, const Vector<3> &x) const;
  [[nodiscard]] Index add_vertex(const EdgeFeature &feature, const Vector<3> &x);
  [[nodiscard]] bool is_clear(Index v, double closest) const;
  [[nodiscard]] bool enter(Index v, const EdgeFeature &feature,
                           const Acceptance &acceptance);
  [[nodiscard]] bool widen_shell(Index v);
};

} // namespace anistar
