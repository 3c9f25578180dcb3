#pragma once
// The constrained Delaunay cavity of a new point: the cells whose circumscribed sphere
// holds it, as far as no wall hides them, and the walls of its own facets in between.
//
// Facets never get a smaller one: through a smaller one triangles are left in a facet
// that are not Delaunay, the insertion radius lemma is false for them, and the
// refinement does not end (studies/cdt.md, section 3). Where the cavity cannot be used
// as it is, the rules take another point or refuse.
//
// There is one exception, in space, for points on edges. Of long edges side by side, as
// around a hole, the point of each encroaches upon the others; cells behind them hold
// it in their spheres, and it sees only a part of them. No star fills such a cavity
// before the other edges are split, and these wait for this one. So cells that are
// hidden stay then, and those around an edge that would be buried, though all walls go
// that should. Flips (flips.h) mend what can be mended at once. The other edges,
// encroached now, are next, by rule 1, before any other decision, and take the rest.

#include "generate/refinement/mesh/walled_mesh.h"

#include <span>
#include <vector>

namespace anistar::generate {

/// Why a cavity cannot be filled with the star of its point.
enum class CavityFlaw {
  no_flaw,
  not_star_shaped, ///< a facet of its boundary does not see the point, or is flat with
                   ///< it
  buries_vertex,
  buries_subsegment, ///< another one than that which is split
  folds_facet,       ///< its part in a facet is not a disk around the point
};

/// Where a new point is, besides its coordinates.
struct Site {
  Vector<3> x;
  Carrier carrier;
  std::vector<Index> seeds;       ///< cells that it takes away in any case
  std::vector<Index> open_facets; ///< the facets that it is on, sorted
  Segment split_edge{none, none}; ///< the subsegment that it is on
  bool may_leave_hidden = false;  ///< cells of which it sees a part
};

class Cavity {
public:
  /// Gathers the cavity of a site.
  [[nodiscard]] CavityFlaw gather(WalledMesh &mesh, const Site &site);
  /// Fills it with the star of its point.
  /// @pre gather has found no flaw, and the mesh is as it was
  /// @returns the new vertex
  Index fill(WalledMesh &mesh, const Site &site);

  /// The cells that go.
  [[nodiscard]] std::span<const Index> cells() const { return cells_; }
  /// Half-facets of these cells that stay; those that are walls and those that are not.
  [[nodiscard]] std::span<const HalfFacet> boundary() const { return boundary_; }
  /// After fill: the new cells, whose facets opposite their last vertex, which is the
  /// new one, are the boundary.
  [[nodiscard]] std::span<const Index> new_cells() const { return new_cells_; }
  [[nodiscard]] bool contains(Index c) const {
    return static_cast<std::size_t>(c) < mark_.size() && mark_[c] == inside_mark();
  }
  /// Distance from the point to the nearest vertex: the insertion radius of the slides.
  [[nodiscard]] double nearest_vertex(const WalledMesh &mesh, const Vector<3> &x) const;
  /// Subsegments among the edges of the cells.
  void subsegments(const WalledMesh &mesh, std::vector<Segment> &out) const;
  /// Whether round-off has let cells on the two sides of a facet of the point disagree,
  /// so that one was taken that its sphere would have spared.
  [[nodiscard]] bool is_enlarged() const { return is_enlarged_; }
  /// Whether hidden cells stay.
  [[nodiscard]] bool is_reduced() const { return is_reduced_; }

private:
  /// Per edge of a boundary facet, opposite its vertex k: the facet of the boundary
  /// that the new cell there meets, and the facet of the complex that the new facet is
  /// on.
  struct Rim {
    std::array<Index, 3> partner{none, none, none};
    std::array<Index, 3> facet{none, none, none};
  };
  std::vector<Index> cells_;
  std::vector<std::array<Index, 4>> boundary_index_; ///< of each cell in cells_
  std::vector<HalfFacet> boundary_;
  std::vector<Segment> boundary_subsegments_; ///< sorted
  std::vector<Rim> rims_;
  std::vector<Index> new_cells_;
  std::vector<HalfFacet> outer_;
  PerCell<std::uint32_t> mark_; ///< 2 round: inside, 2 round + 1: known to be outside
  PerCell<Index> position_;     ///< in cells_
  PerVertex<std::uint32_t> on_boundary_;
  std::uint32_t round_ = 0;
  bool is_enlarged_ = false, is_reduced_ = false;

  [[nodiscard]] CavityFlaw flaw_of_star(const WalledMesh &mesh, const Site &site);
  bool leave_hidden(const WalledMesh &mesh, const Site &site);
  std::size_t leave_around_buried(const WalledMesh &mesh, const Site &site);
  [[nodiscard]] std::size_t n_open_walls(const WalledMesh &mesh,
                                         const Site &site) const;
  void keep_connected(const WalledMesh &mesh, const Site &site);

  [[nodiscard]] std::uint32_t inside_mark() const { return 2 * round_; }
  void start(const WalledMesh &mesh);
  void take(Index c);
  void flood(const WalledMesh &mesh, const Site &site, bool only_visible);
  void find_boundary(const WalledMesh &mesh, const Site &site);
  [[nodiscard]] bool is_star_shaped(const WalledMesh &mesh, const Site &site) const;
  [[nodiscard]] CavityFlaw what_is_buried(const WalledMesh &mesh, const Site &site);
  [[nodiscard]] bool find_rims(const WalledMesh &mesh);
  [[nodiscard]] bool is_buried(const Segment &edge, const WalledMesh &mesh,
                               const Site &site) const;
  void find_boundary_subsegments(const WalledMesh &mesh);
};

} // namespace anistar::generate
