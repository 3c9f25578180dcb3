#pragma once
// Takes cells out of the mesh that are flat, or turned over once coordinates are
// rounded.

#include "base/monitor.h"
#include "generate/constrained/facets/facet_triangles.h"
#include "generate/constrained/flat/steiner_moves.h"
#include "generate/constrained/flat/swaps.h"
#include "generate/constrained/flat/volume_points.h"

#include <vector>

namespace anistar::generate {

/// Four points on one circle make a flat cell of a Delaunay mesh, and points of a
/// nearly planar facet make flat cells on it. The former are swapped away; the latter
/// are peeled off: the facet passes to their other side. Where neither helps, a point
/// in the volume does.
class FlatCells {
public:
  struct Counts {
    std::size_t peeled = 0, swapped = 0, moved = 0, inserted = 0;
    std::size_t left = 0, on_flat_walls = 0; ///< cells that are flat still
  };

  FlatCells(ExactPoints &points, GhostMesh &mesh, const FacetTriangles &facets,
            PerCell<Index> &regions);

  /// @param may_peel whether facets may move within their flatness
  Counts remove(bool may_peel, Monitor &monitor);

private:
  ExactPoints &points_;
  GhostMesh &mesh_;
  const FacetTriangles &facets_;
  PerCell<Index> &regions_;
  std::vector<Index> facet_of_plane_;
  Swaps swaps_;
  SteinerMoves moves_;
  VolumePoints volume_points_;
  Counts counts_;

  [[nodiscard]] bool is_inside(Index c) const;
  [[nodiscard]] std::vector<Index> flat_cells(double bound) const;
  [[nodiscard]] bool is_on_wall(Index a, Index b) const;

  /// A flat cell with two walls of one facet, at places i and j; k and l are the
  /// others.
  struct Peel {
    Index cell;
    std::size_t i, j, k, l;
  };
  [[nodiscard]] std::optional<Peel> peel_of(Index c) const;
  void pass_walls(const Peel &peel);
  bool peel_outwards(Index c);
  bool peel_and_swap(Index c);
  bool swap(Index c);
  bool swap_after_another(Index c);
  bool move(Index c);
  void insert_points(Monitor &monitor);
  bool insert_point(Index c);
  [[nodiscard]] bool has_flat_wall(Index c) const;
  [[nodiscard]] std::vector<Swap> swaps_at(Index c);
  std::vector<Index> make(const Swap &swap);
};

} // namespace anistar::generate
