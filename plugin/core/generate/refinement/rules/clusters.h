#pragma once
// Clusters of segments (Terminator 3D, rule 1): those that leave a vertex at angles
// below 60 degrees are split on spheres around it, of radii 2^k, so that no new point
// of one encroaches upon a piece of another.

#include "generate/refinement/mesh/walled_mesh.h"

#include <limits>
#include <vector>

namespace anistar::generate {

class Clusters {
public:
  explicit Clusters(const WalledMesh &mesh);

  /// Where a subsegment of a segment is split, as a fraction of the way from a to b.
  [[nodiscard]] double split_fraction(const WalledMesh &mesh, Index segment, Index a,
                                      Index b) const;
  /// min r_w over W, the vertices that are inserted when the subsegment is split: on a
  /// sphere of a cluster its neighbours in the cluster follow.
  [[nodiscard]] double least_insertion_radius(const WalledMesh &mesh, Index segment,
                                              Index a, Index b) const;
  [[nodiscard]] std::size_t n_clusters() const { return n_clusters_; }

private:
  static constexpr double no_cluster = std::numeric_limits<double>::infinity();
  /// Of an end of a segment: the least distance of two points of its cluster on the
  /// unit sphere.
  struct End {
    Index vertex = none;
    double gap = no_cluster;
  };
  std::vector<std::array<End, 2>> ends_;
  std::size_t n_clusters_ = 0;

  [[nodiscard]] const End *clustered_end(Index segment, Index v) const;
};

} // namespace anistar::generate
