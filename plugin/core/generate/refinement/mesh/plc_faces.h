#pragma once
// The faces of the complex and how they meet: which are disjoint, which pairs of facets
// form an acute dihedral angle. All of it is combinatorial: a point is on a facet
// because it was put there, not because its coordinates say so.

#include "generate/refinement/mesh/carrier.h"
#include "generate/refinement/mesh/walled_mesh.h"

#include <map>
#include <optional>
#include <span>
#include <vector>

namespace anistar::generate {

/// Lists of indices, one after another.
class IndexLists {
public:
  using Pair = std::array<Index, 2>;

  IndexLists() = default;
  /// The second entries of the pairs under their first ones, sorted, each once.
  IndexLists(std::vector<Pair> pairs, std::size_t n_lists);

  [[nodiscard]] std::span<const Index> operator[](Index list) const {
    return std::span(entries_).subspan(begin_[list], begin_[list + 1] - begin_[list]);
  }
  [[nodiscard]] bool contains(Index list, Index entry) const;

private:
  std::vector<std::size_t> begin_{0};
  std::vector<Index> entries_;
};

/// Where the walls of a facet are looked at from, to decide left and right on it.
struct Projection {
  std::uint8_t axis = 2; ///< the coordinate that is left out

  [[nodiscard]] Vector<2> operator()(const Vector<3> &x) const {
    return {x[(axis + 1) % 3], x[(axis + 2) % 3]};
  }
};

class PlcFaces {
public:
  /// @pre the mesh is the constrained Delaunay tetrahedralisation that nothing has been
  /// inserted into
  explicit PlcFaces(const WalledMesh &mesh);

  /// The facets whose closure holds what the carrier holds, sorted.
  [[nodiscard]] std::span<const Index> facets_of(const Carrier &carrier) const;
  [[nodiscard]] bool is_on(const Carrier &carrier, Index facet) const;
  /// Whether a face has no point in common with a facet.
  [[nodiscard]] bool are_disjoint(const Carrier &carrier, Index facet) const;
  /// Whether two facets share a segment at which the domain between them has an angle
  /// below acute_dihedral.
  [[nodiscard]] bool are_acute(Index facet, Index other) const {
    return acute_.contains(facet, other);
  }
  /// Whether a vertex is on a facet that forms an acute pair with this one, and not on
  /// this one itself.
  [[nodiscard]] bool is_across_acute_angle(const Carrier &carrier, Index facet) const;
  /// Whether two vertices are on two facets of an acute pair, neither on both.
  [[nodiscard]] bool join_acute_facets(const Carrier &one, const Carrier &other) const {
    return cosine_between(one, other).has_value();
  }
  /// The cosine of the least angle of the acute pairs that they are on so.
  [[nodiscard]] std::optional<double> cosine_between(const Carrier &one,
                                                     const Carrier &other) const;

  [[nodiscard]] Projection projection(Index facet) const { return projections_[facet]; }
  [[nodiscard]] std::size_t n_acute_pairs() const { return n_acute_pairs_; }
  /// The two ends of a segment.
  [[nodiscard]] Segment ends(Index segment) const { return ends_[segment]; }

private:
  IndexLists vertex_facets_, segment_facets_, facet_vertices_, acute_;
  std::map<IndexLists::Pair, double> acute_cosines_; ///< the largest of each pair
  std::vector<Projection> projections_;
  std::vector<Segment> ends_;
  std::size_t n_acute_pairs_ = 0;

  void find_incidences(const WalledMesh &mesh);
  void find_projections(const WalledMesh &mesh);
  void find_acute_pairs(const WalledMesh &mesh);
};

} // namespace anistar::generate
