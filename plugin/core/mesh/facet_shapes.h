#pragma once
// What a smooth shape does at each facet of the geometry that samples it.

#include <vector>

namespace anistar {

/// One entry a facet, and in 3D one a given ridge edge.
struct FacetShapes {
  std::vector<double> measure; ///< length or area of the smooth shape
  std::vector<double> bulge;   ///< area or volume that it adds behind the facet, where
                               ///< the normal does not point
  std::vector<double> sag;     ///< how far it may lie from the facet, see chord_sag.h

  std::vector<double> edge_length; ///< of the smooth ridge

  explicit FacetShapes(std::size_t n_facets, std::size_t n_edges = 0)
      : measure(n_facets, 0), bulge(n_facets, 0), sag(n_facets, 0),
        edge_length(n_edges, 0) {}
};

} // namespace anistar
