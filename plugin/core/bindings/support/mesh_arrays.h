#pragma once
// A mesh as NumPy arrays, as it goes into the core and as it comes out.

#include "bindings/support/geometry.h"

namespace anistar::bindings {

/// Holds references to the arrays: nothing is copied.
struct MeshArrays {
  Array2<double> points;    ///< (n, d)
  Array2<Index> cells;      ///< (m, d + 1)
  Array1<Index> cell_tags;  ///< (m,)
  Array2<Index> facets;     ///< (k, d)
  Array1<Index> facet_tags; ///< (k,)
  Array2<Index> edges;      ///< (l, 2), the ridges of a 3D mesh
  Array1<Index> edge_tags;  ///< (l,)
  Array1<Index> corners;

  [[nodiscard]] std::size_t dimension() const { return cells.shape(1) - 1; }
};

} // namespace anistar::bindings
