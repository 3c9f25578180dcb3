#pragma once
// Nearest facets.

#include "base/tensor.h"
#include "mesh/adjacency.h"

#include <span>
#include <vector>

namespace anistar {

struct NearestFacet {
  Index facet;
  double distance;
};

/// For every query the facet nearest to it; of facets equally near, the first.
/// @pre there are facets; the queries are in range.
template <std::size_t d>
[[nodiscard]] std::vector<NearestFacet>
nearest_facets(std::span<const Vector<d>> points, std::span<const Facet<d>> facets,
               std::span<const Vector<d>> queries);

} // namespace anistar
