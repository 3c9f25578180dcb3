#pragma once
// Bistellar flips that make facets locally Delaunay again where a cavity was smaller
// than the constrained Delaunay one.
//
// A facet f between the apexes a and b is flipped if b is inside of the sphere of the
// cell of a. What may come in its place are the three cells that have b for a vertex of
// f. Is each of them positive, they replace the two (2-3). Is one of them not, but,
// with its orientation reversed, the third cell around its edge of f, the other two
// replace these three (3-2). Each flip lowers the surface that the points lifted to the
// paraboloid have below them, so that none comes twice.
//
// No wall and no subsegment goes. A facet that cannot be flipped is kept in mind: long
// edges side by side make room for each other one by one.

#include "generate/refinement/mesh/walled_mesh.h"

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

namespace anistar::generate {

class Flips {
public:
  /// Flips what is not locally Delaunay among the facets of these cells, and of those
  /// that come of it.
  void restore(WalledMesh &mesh, std::span<const Index> cells);
  /// The same for what could not be flipped so far.
  void retry(WalledMesh &mesh);

  /// The cells that the last call has made, sorted; some may have gone again.
  [[nodiscard]] std::span<const Index> new_cells() const { return new_cells_; }
  [[nodiscard]] bool has_made(Index c) const {
    return std::binary_search(new_cells_.begin(), new_cells_.end(), c);
  }
  [[nodiscard]] bool has_waiting() const { return !stuck_.empty(); }

private:
  struct Waiting {
    HalfFacet facet;
    std::uint32_t birth; ///< of its cell
  };
  /// Two or three cells in place of three or two.
  struct Flip {
    std::vector<Index> dead;
    std::vector<Cell<3>> born;
    std::size_t open_corner = 3; ///< 3-2: the k whose cell is there already
  };
  std::vector<Waiting> line_, stuck_;
  std::vector<Index> new_cells_;

  void push_facets(const WalledMesh &mesh, Index c);
  void flip_all(WalledMesh &mesh);
  [[nodiscard]] std::optional<Flip> flip_of(const WalledMesh &mesh, HalfFacet h) const;
  void apply(WalledMesh &mesh, HalfFacet h, const Flip &flip);
};

/// Whether a facet without a wall has the vertex beyond it inside of the sphere of its
/// cell.
[[nodiscard]] bool is_locally_delaunay(const WalledMesh &mesh, HalfFacet h);

} // namespace anistar::generate
