#pragma once
// One facet cut into triangles.

#include "generate/facets/facet_loops.h"
#include "generate/plc.h"

#include <memory>
#include <vector>

namespace anistar::generate {

/// Cuts facets of a complex into triangles, one facet after the other.
class FacetTriangulation {
public:
  explicit FacetTriangulation(std::span<const Vector<3>> points);
  ~FacetTriangulation();
  FacetTriangulation(const FacetTriangulation &) = delete;
  FacetTriangulation &operator=(const FacetTriangulation &) = delete;

  /// The triangles of a facet, as it looks along the axis nearest to `normal`.
  /// @param edges Between points of the facet.
  /// @throws std::invalid_argument if its loops cross or are not where they should be.
  [[nodiscard]] std::vector<Facet<3>> triangles(const FacetLoops &facets,
                                                std::size_t facet,
                                                const Vector<3> &normal,
                                                std::span<const Segment> edges);

private:
  class Work;
  std::unique_ptr<Work> work_;
};

} // namespace anistar::generate
