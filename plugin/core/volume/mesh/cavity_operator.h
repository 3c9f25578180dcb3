#pragma once
// The cavity operator in 3D: cells are replaced by the star of one vertex, and with
// them the patches of surface that they hold.
//
// Insertion, collapse, swap and re-insertion are this one operation with different
// cavities (Loseille and Loehner, Cavity-based operators for mesh adaptation, 2013;
// Loseille, Unique cavity-based operator, 2015).

#include "volume/mesh/volume.h"

namespace anistar {

/// What is better than a quality by a gain, or by a tenth of it: where the metric is
/// far thinner than the domain no cell is good, and small steps up are large ones.
[[nodiscard]] inline double better_by(double gain, double quality) {
  return quality + std::min(gain, .1 * std::abs(quality));
}

/// What the new cells must be like. The worst of them must reach `floor`, or be better
/// than the worst old cell (see better_by), whichever asks less: so what is stuck below
/// the floor can be repaired step by step.
struct Acceptance {
  double floor = 0;
  double gain = 1e-4;
  double longest = 0; ///< bound of the lengths at the apex; 0: none
  /// Bound of the distance of new edges of curved surfaces from them, relative to the
  /// edge; 0: none.
  double hausdorff_number = 0;
  /// When positive, this share of the quality of the worst old cell is enough too:
  /// where the metric is far thinner than the cells, nothing reaches a fixed floor.
  double share = 0;
  /// Whether the apex is where it was when its cells were measured: those of them that
  /// stay need not be measured again.
  bool is_apex_in_place = false;

  /// @param kept what nothing may take the worst cell below, nor further below
  [[nodiscard]] double threshold(double old_minimum, double kept) const {
    const double least = std::min(floor, better_by(gain, old_minimum));
    return std::max(share > 0 ? std::min(least, share * old_minimum) : least,
                    std::min(kept, old_minimum));
  }
};

/// Accepts only what is better than before.
[[nodiscard]] inline Acceptance improvement(double gain = 1e-3,
                                            double hausdorff_number = 0) {
  return {std::numeric_limits<double>::infinity(), gain, 0, hausdorff_number};
}

class CavityOperator {
public:
  explicit CavityOperator(Volume &volume) : volume_(volume), table_(table_size) {}

  /// Replaces `cells` by the star of `apex`, if the result is valid: every new cell has
  /// a volume, no vertex is left over but the lost one, the regions and the surfaces
  /// keep their shape, and the quality is acceptable.
  /// @param lost what vanishes: {none, none}, a vertex {v, none}, or an edge {a, b};
  /// boundary facets that contain it are replaced by those of the apex.
  /// In a slab what would touch a cell outside of it is put off.
  /// @pre the cells are in the slab.
  bool replace(std::span<const Index> cells, Index apex, std::array<Index, 2> lost,
               const Acceptance &acceptance);

  /// The same in two steps, to look at what would come of it: @returns whether the
  /// result is valid. The mesh changes with commit(), before the next proposal, or not
  /// at all.
  [[nodiscard]] bool propose(std::span<const Index> cells, Index apex,
                             std::array<Index, 2> lost, const Acceptance &acceptance);
  void commit(std::span<const Index> cells);
  /// visit({a, b, c, d, e}) for the facets abc of the proposal that are no walls: those
  /// of its cells and those that it brings together, between the cell abcd and e.
  template <class Visit> void for_new_facets(Visit visit) const;
  /// visit({a, b, c}, patch, {d, e}) for its walls: the facet abc of the cells with the
  /// apexes d and e, which is none on the boundary.
  template <class Visit> void for_new_walls(Visit visit) const;
  /// visit(quality, cell) for its cells, which have numbers once it is committed.
  template <class Visit> void for_new_cells(Visit visit) const;

private:
  enum class Kind : std::uint8_t {
    base,    ///< a new cell will stand on it
    at_apex, ///< a facet of the cavity's boundary that contains the apex: it stays
    rim      ///< an edge of the hole in the boundary that the new facets close
  };
  struct Outer {
    std::array<Index, 3> v; ///< rim: the edge and none
    HalfFacet beyond;
    Index constraint, region;
    float quality;
    Kind kind;
    std::uint8_t apex_at;
    Index cell; ///< the new one
  };
  struct SurfaceEdge { ///< together with the apex it becomes a facet of a patch
    std::array<Index, 2> ends;
    Index patch;
    bool is_boundary;
    Vector<3> normal; ///< of the old facet
  };
  struct Port {
    Index outer;
    std::size_t slot; ///< of the vertex of `outer` that the facet does not contain
  };
  struct Pair {
    Port one, other;
    Index constraint;
  };

  static constexpr Index max_local = 128;
  static constexpr std::size_t table_size = max_local * max_local;
  static constexpr std::size_t max_outer = 512;

  Volume &volume_;
  Index apex_ = none;
  bool is_apex_in_place_ = false;
  std::array<Index, 2> lost_{};
  std::vector<Outer> outers_;
  std::vector<SurfaceEdge> surface_;
  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> table_; ///< directed edges: epoch and port
  std::uint32_t epoch_ = 0;
  std::vector<Index> local_, local_of_;
  std::vector<Index> around_;        ///< cells of the apex outside of the cavity
  std::vector<int> before_, after_;  ///< facets of surfaces at the edges of the apex
  std::vector<std::uint8_t> joined_; ///< local vertices that keep their edge to it
  bool has_walls_ = false;

  /// visit({a, b, c}, patch, {d, e}) for all facets of the proposal.
  template <class Visit> void for_new(Visit visit) const;
  [[nodiscard]] bool is_lost(const std::array<Index, 3> &facet) const;
  [[nodiscard]] bool is_lost(Index u, Index w) const;
  [[nodiscard]] bool collect(std::span<const Index> cells,
                             const Acceptance &acceptance);
  [[nodiscard]] bool add_outer(HalfFacet h, double threshold);
  void add_surface(HalfFacet h, bool is_boundary);
  [[nodiscard]] bool keeps_sides() const;
  [[nodiscard]] bool add_rim(double hausdorff_number);
  [[nodiscard]] bool keeps_vertices(std::span<const Index> cells);
  [[nodiscard]] bool keeps_lengths(double longest);
  [[nodiscard]] bool keeps_shape(std::span<const Index> cells) const;
  [[nodiscard]] bool match();
  [[nodiscard]] bool match_port(Index outer, std::size_t slot);
  [[nodiscard]] bool constrain();
  [[nodiscard]] bool separates_regions() const;
  [[nodiscard]] bool keeps_link();
  [[nodiscard]] bool keeps_facets_apart() const;
  [[nodiscard]] bool keeps_bodies_apart(std::span<const Index> cells) const;
  [[nodiscard]] bool keeps_surface_links(std::span<const Index> cells);
  [[nodiscard]] int sheets_at_lost(Index v, std::span<const Index> cells) const;
  [[nodiscard]] bool is_ridge(Index u, Index v) const;
  [[nodiscard]] bool is_new_ridge(Index v) const;
  [[nodiscard]] Index local_index(Index v);
  [[nodiscard]] Index region_at(const Port &port) const;
  [[nodiscard]] HalfFacet half_of(const Port &port) const;
  /// The vertex of the cell at a port that its facet does not contain.
  [[nodiscard]] Index vertex_off(const Port &port) const {
    const Outer &outer = outers_[port.outer];
    return outer.kind == Kind::base ? outer.v[port.slot]
                                    : volume_.mesh.apex(outer.beyond);
  }
  [[nodiscard]] bool stays_in_slab(std::span<const Index> cells) const;
  void join_pairs();
  void update_fans(std::span<const Index> cells);
};

template <class Visit> void CavityOperator::for_new_cells(Visit visit) const {
  for (const Outer &outer : outers_)
    if (outer.kind == Kind::base)
      visit(static_cast<double>(outer.quality), outer.cell);
}

template <class Visit> void CavityOperator::for_new_facets(Visit visit) const {
  for_new([&](const Facet<3> &t, Index patch, std::array<Index, 2> apexes) {
    if (patch == none)
      visit(std::array<Index, 5>{t[0], t[1], t[2], apexes[0], apexes[1]});
  });
}

template <class Visit> void CavityOperator::for_new_walls(Visit visit) const {
  for_new([&](const Facet<3> &t, Index patch, std::array<Index, 2> apexes) {
    if (patch != none)
      visit(t, patch, apexes);
  });
}

/// What is below the new cells, and what lies between two of them or between one and a
/// cell at the apex that stays.
template <class Visit> void CavityOperator::for_new(Visit visit) const {
  const Triangulation<3> &mesh = volume_.mesh;
  for (const Outer &outer : outers_)
    if (outer.kind == Kind::base)
      visit(outer.v, outer.constraint,
            {apex_, outer.beyond.exists() ? mesh.apex(outer.beyond) : none});
  const auto has_cell = [&](const Port &port) {
    const Outer &outer = outers_[port.outer];
    return outer.kind == Kind::base || outer.beyond.exists();
  };
  for (const Pair &pair : pairs_) {
    // one of them has a cell, or the facet would have none
    const bool is_first = has_cell(pair.one);
    const Port &port = is_first ? pair.one : pair.other,
               &beyond = is_first ? pair.other : pair.one;
    const Outer &outer = outers_[port.outer];
    const Facet<3> t =
        outer.kind == Kind::base
            ? facet_of<3>({outer.v[0], outer.v[1], outer.v[2], apex_}, port.slot)
            : mesh.facet(outer.beyond);
    visit(t, pair.constraint,
          {vertex_off(port), has_cell(beyond) ? vertex_off(beyond) : none});
  }
}

} // namespace anistar
