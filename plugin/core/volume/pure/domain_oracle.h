#pragma once
// What the algorithm asks of the domain: where a point is, and where a segment meets a
// surface.

#include "search/box_tree.h"
#include "volume/mesh/volume.h"

#include <optional>

namespace anistar {

/// The domain is that of the input mesh, and its surfaces are the facets of that: the
/// centres of surface balls lie on them, and new sites are then put on the smooth
/// surface.
class DomainOracle {
public:
  /// @param start the input mesh on its surfaces and ridges
  /// @param region of the cells of the background
  DomainOracle(const Volume &start, std::span<const Index> region);

  struct Facet {
    std::array<Vector<3>, 3> corners;
    Index patch;
  };
  /// The region of a point, none outside. Exact for the stored doubles.
  /// @param cell a hint, and afterwards the nearest cell
  [[nodiscard]] Index region(const Vector<3> &x, Index &cell) const;

  struct Crossing {
    Index facet = none;
    Vector<3> x = Vector<3>::Zero();
  };
  /// Where a segment meets a facet, the farthest of such points from a place in a
  /// metric. Whether it does is exact for the stored doubles.
  [[nodiscard]] Crossing crossing(const Vector<3> &a, const Vector<3> &b,
                                  const Vector<3> &from,
                                  const SymmetricTensor<3> &M) const;
  /// The place near x on the smooth surface of a patch.
  [[nodiscard]] Vector<3> on_patch(Index patch, const Vector<3> &x) const {
    return shape_.place(2, patch, x);
  }
  /// Whether x, which was put on a patch, is near some facet of it: planes go on beyond
  /// their patch.
  [[nodiscard]] bool is_on_patch(Index patch, const Vector<3> &x) const;
  [[nodiscard]] const Facet &facet(Index k) const { return facets_[k]; }
  [[nodiscard]] const std::vector<Facet> &facets() const { return facets_; }
  [[nodiscard]] const SurfaceShape &shape() const { return shape_; }
  [[nodiscard]] const Background<3> &background() const { return background_; }
  [[nodiscard]] const Box<3> &box() const { return box_; }

private:
  const Background<3> &background_;
  const SurfaceShape &shape_;
  std::span<const Index> region_;
  std::vector<Facet> facets_;
  Box<3> box_;
  BoxTree<3> tree_;
  double facet_size_ = 0; ///< mean of the longest sides of their boxes

  [[nodiscard]] static std::vector<Facet> facets_of(const Volume &start);
  [[nodiscard]] std::vector<Box<3>> boxes() const;
};

} // namespace anistar
