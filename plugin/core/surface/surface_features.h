#pragma once
// What the facets and edges of a mesh are: patches, ridges and corners.

#include "surface/surface_input.h"

#include <functional>

namespace anistar {

struct RidgeSegment {
  std::array<Index, 2> ends;
  Index curve;
};

/// The features of a surface: which patch every facet belongs to, the ridges, and for
/// every point the dimension of its feature (0 corner, 1 ridge, 2 surface, 3 interior)
/// and the curve or patch it lies on.
struct Features {
  std::vector<Patch> patches;
  std::vector<SurfaceCurve> curves;
  std::vector<Index> facet_patch;
  std::vector<RidgeSegment> ridges;
  std::vector<Index> dimension, support;
};

/// An edge is a ridge when it is given, when other than two facets meet there, where
/// tags change, and where the surface turns by at least the ridge angle. A point of a
/// ridge is a corner when it is given, when other than two ridge edges meet there,
/// where they turn by the ridge angle or differ in tag, and on frozen facets.
/// @param has_ridge_at asked of an edge that only an angle makes a ridge, when given
[[nodiscard]] Features
find_features(const SurfaceInput &input,
              const std::function<bool(Index, Index)> &has_ridge_at = {});

} // namespace anistar
