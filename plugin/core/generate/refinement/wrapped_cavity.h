#pragma once
// The constrained Delaunay cells of a cavity that is no star of its point.
//
// Where edges of the boundary are long and near to each other, as around a hole, the
// point of one sees only a part of a cell that hides behind another. The whole cell goes
// all the same, and what is behind gets cells without the new point: the constrained
// Delaunay tetrahedralisation of the cavity, by gift-wrapping, as for the facets of the
// first mesh. What it gives is checked before it is used: cells with a volume, locally
// Delaunay at every facet that is no wall, all subsegments there.

#include "generate/refinement/walled_mesh.h"

#include <span>
#include <vector>

namespace anistar::generate {

struct Site;

/// A cavity as it was found: its cells, and which of their facets stay.
struct CavityBorder {
  std::span<const Index> cells;
  std::span<const HalfFacet> staying;
  std::span<const HalfFacet> opened; ///< walls of facets of the point
};

class WrappedCavity {
public:
  /// Whether there are such cells; the mesh is not changed.
  [[nodiscard]] bool find(const WalledMesh &mesh, const CavityBorder &border,
                          const Site &site);
  /// Puts them into the mesh, whose newest vertex is that of the site.
  void put(WalledMesh &mesh, std::vector<Index> &new_cells) const;

private:
  /// A facet between two cells, or a cell and the border.
  struct CellFacet {
    Facet<3> vertices; // sorted
    Index cell;        // of the new ones
    std::size_t facet;
  };
  struct Stay {
    Facet<3> vertices; // sorted
    HalfFacet outer;
    Index wall;
  };
  struct Wall {
    Facet<3> vertices; ///< the inside is on the positive side
    Index facet;
  };
  struct Joint {
    Index cell;
    std::size_t facet;
    HalfFacet outer;         ///< in the mesh, or
    Index other_cell = none; ///< among the new ones
    std::size_t other_facet = 0;
    Index wall = none;
  };
  std::vector<Cell<3>> cells_;
  std::vector<Joint> joints_;
  std::vector<Wall> new_walls_;
  Index region_ = none;

  [[nodiscard]] bool find_new_walls(const WalledMesh &mesh, const CavityBorder &border,
                                    const Site &site);
  [[nodiscard]] bool wrap(const WalledMesh &mesh, const CavityBorder &border,
                          const Site &site);
  [[nodiscard]] bool join(const WalledMesh &mesh, const CavityBorder &border);
  [[nodiscard]] bool is_delaunay(const WalledMesh &mesh, const Site &site) const;
  [[nodiscard]] bool keeps_subsegments(const WalledMesh &mesh,
                                       const CavityBorder &border,
                                       const Site &site) const;
};

} // namespace anistar::generate
