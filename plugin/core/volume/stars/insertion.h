#pragma once
// Points that enter a volume mesh by their metric-Delaunay cavity: Algorithm 1 of
// RR-7712 v2 on one valid mesh, and what pick_valid (Algorithm 3) asks of a point.

#include "stars/algorithm_2.h"
#include "volume/mesh/cavity_operator.h"
#include "volume/stars/facet_margins.h"

namespace anistar {

/// What pick_valid compares; less is better.
struct PointScore {
  int slivers = std::numeric_limits<int>::max(); ///< that the point would make
  int failing = 0; ///< change of the number of facets that fail, of surfaces too
  double cost = 0; ///< change of the total of AgreementCost

  [[nodiscard]] bool is_better(const PointScore &other) const {
    return slivers != other.slivers ? slivers < other.slivers : cost < other.cost;
  }
};

/// The new cells are not of less quality.
inline constexpr double quality_floor = .3;

/// How a point enters the mesh.
struct EntryRule {
  double closest;                        ///< to another vertex, in its own metric
  std::array<Index, 2> lost{none, none}; ///< the edge that it splits
  Index vertex = none; ///< that it moves; all its cells are among the seeds
};

using ScoredPlace = ScoredPoint<3, PointScore>;

/// The cavity of one point after another.
class VolumeInsertion {
public:
  /// @pre both outlive this object
  VolumeInsertion(Volume &volume, const SurfaceNormals &normals)
      : volume_(volume), normals_(normals) {}

  /// Takes up a point: the cells around the seeds whose M_p-ball contains it, less
  /// those that would leave a cell below the floor. Walls are not crossed.
  /// @returns false when it swallows a vertex or a ridge, comes too near to a vertex,
  /// or a seed cannot be part of its cavity.
  [[nodiscard]] bool gather(const Vertex<3> &p, std::span<const Index> seeds,
                            const EntryRule &rule);
  /// A constrained facet of the cavity that the point encroaches upon: it lies in a
  /// surface ball of one of its vertices.
  [[nodiscard]] HalfFacet encroached() const;
  /// @param sigma_0 cells of less sliverity are slivers
  /// @param radius circumradius up to which they count
  [[nodiscard]] PointScore score(double sigma_0, double radius);
  [[nodiscard]] const std::vector<Index> &cells() const { return cells_; }
  /// The vertices that the point would be joined to.
  [[nodiscard]] const std::vector<Index> &link() const { return link_; }

private:
  struct Outer { ///< a facet that the point would be joined to
    HalfFacet facet;
    std::array<Index, 3> v;
  };
  struct Spoke { ///< an edge of the cavity's boundary, and the vertex beside it
    Index low, high, apex, base;
  };

  Volume &volume_;
  const SurfaceNormals &normals_;
  Vertex<3> p_{};
  EntryRule rule_{};
  std::vector<Index> cells_, link_;
  std::vector<Outer> outers_;
  std::vector<Spoke> spokes_;
  std::vector<std::uint32_t> stamp_; ///< per cell: in the cavity of this epoch
  std::uint32_t epoch_ = 0;

  [[nodiscard]] bool contains(Index c) const { return stamp_[c] == epoch_; }
  [[nodiscard]] bool holds(const Facet<3> &facet) const;
  void open();
  void grow();
  [[nodiscard]] bool shrink(std::size_t n_seeds);
  void bound();
  [[nodiscard]] bool keeps_vertices();
  [[nodiscard]] bool keeps_ridges() const;
  [[nodiscard]] bool stays(Index a, Index b) const;
  [[nodiscard]] double wall_margin_at(const Outer &outer, const Vertex<3> &apex) const;
  [[nodiscard]] AgreementCost cost_before() const;
  [[nodiscard]] AgreementCost cost_after();
  [[nodiscard]] bool is_sliver(const Outer &outer, double sigma_0, double radius) const;
};

} // namespace anistar
