#pragma once
// The ridges of the domain as edges between sites.

#include "volume/pure/star_set.h"

namespace anistar {

/// An edge of a ridge, in the stars of both of its ends unless sites encroach upon it.
class RidgeEdges {
public:
  explicit RidgeEdges(std::vector<RidgeEdge> edges);

  [[nodiscard]] const std::vector<RidgeEdge> &edges() const { return edges_; }
  /// An edge at v that is not in its star, none if there is none.
  [[nodiscard]] Index missing(const StarSet &stars, Index v) const;
  /// The edge whose diametral ball holds a point most deeply, in the metrics of its two
  /// ends; none if there is none.
  [[nodiscard]] Index encroached(const StarSet &stars, const Vector<3> &x) const;
  /// Halves an edge at the site v.
  void split(Index edge, Index v);

private:
  std::vector<RidgeEdge> edges_;
  std::vector<std::vector<Index>> at_; ///< of every site that has one

  void link(Index edge);
};

} // namespace anistar
