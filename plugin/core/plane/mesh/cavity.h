#pragma once
// The cavity operator: a set of cells is replaced by the star of one point.
//
// Insertion, collapse, swap and re-insertion are this one operation with different
// cavities (Loseille and Loehner, Cavity-based operators for mesh adaptation, 2013;
// Loseille, Unique cavity-based operator, 2015).

#include "mesh/triangulation.h"

#include <cstdint>

namespace anistar {

/// A constraint for the edge from the apex to another vertex.
struct SpokeConstraint {
  Index end, constraint;
};

/// Collects a cavity, tests it and fills it. One object serves a whole sweep: its
/// storage is reused.
class Cavity {
public:
  explicit Cavity(Triangulation<2> &mesh) : mesh_(mesh) {}

  /// From now on new cells, and what insert_in_cell adds, go to these places.
  void take_from(Slots *slots) { slots_ = slots; }
  [[nodiscard]] Slots *slots() const { return slots_; }

  void clear();
  void add(Index cell);
  [[nodiscard]] bool contains(Index cell) const {
    return cell >= 0 && std::cmp_less(cell, stamp_.size()) && stamp_[cell] == epoch_;
  }
  [[nodiscard]] std::span<const Index> cells() const { return cells_; }

  /// Finds the edges over which the star of `apex` will be built: those of the cavity's
  /// boundary that do not contain it. `skipped` edges lie on the boundary of the domain
  /// and end there: the apex is on them, or they vanish.
  void bound(Index apex, std::span<const HalfFacet> skipped = {});
  [[nodiscard]] std::span<const HalfFacet> facets() const { return facets_; }

  /// Whether x sees every one of facets() from inside, and not along it: the test that
  /// keeps the mesh valid.
  [[nodiscard]] bool is_star_shaped(const Vector<2> &x) const;
  /// Whether every vertex of the cavity is on one of facets(): none would vanish.
  [[nodiscard]] bool keeps_vertices() const;

  /// Replaces the cavity by the star of the apex. The new cells keep the region of the
  /// cavity cell behind their facet, outer facets keep their constraints, and `spokes`
  /// gives those of edges at the apex.
  /// @pre bound(apex, ...) was called and is_star_shaped holds; vertices that vanish
  /// lie inside the cavity and are marked unused by the caller.
  void fill(Index apex, std::span<const SpokeConstraint> spokes = {});

  /// The cells that the last fill() made, each as the half-facet opposite the apex.
  [[nodiscard]] std::span<const HalfFacet> star() const { return star_; }

private:
  struct Port { ///< an edge at the apex that waits for its other side
    Index end;  ///< the other end of the edge
    HalfFacet half;
    Index constraint;
  };

  struct Outer { ///< a facet of the cavity's boundary, kept while its cell is replaced
    Cell<2> cell;
    std::size_t facet;
    HalfFacet beyond;
    Index constraint, region;
  };

  Triangulation<2> &mesh_;
  Slots *slots_ = nullptr;
  std::vector<std::uint32_t> stamp_;
  std::uint32_t epoch_ = 0;
  std::vector<Index> cells_;
  std::vector<HalfFacet> facets_;  ///< as seen from the cavity
  std::vector<HalfFacet> at_apex_; ///< boundary facets that contain the apex
  std::vector<HalfFacet> star_;
  std::vector<Outer> outers_, walls_;
  std::vector<Port> ports_;

  [[nodiscard]] Outer outer_of(HalfFacet h) const;
  void make_cells(Index apex);
  void join_cells(std::span<const SpokeConstraint> spokes);
  void connect(const Port &port);
  void join_walls(Index apex);
};

} // namespace anistar
