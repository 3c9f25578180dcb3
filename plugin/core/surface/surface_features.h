#pragma once
// What the facets and edges of a mesh are: patches, ridges and corners.

#include "surface/sharp_folds.h"

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
  /// For every corner of a facet the side of the ridges there that it lies on: corners
  /// at a point share a side when folds that are no ridges join their facets.
  std::vector<Facet<3>> facet_sides;
  std::size_t n_sides = 0;
  std::vector<RidgeSegment> ridges;
  std::vector<Index> dimension, support;
};

/// Which folds are ridges, given the other ridges and those that this surface alone
/// makes sharp.
using RidgeChoice = std::function<std::vector<bool>(
    std::span<const Fold> folds, std::span<const std::array<Index, 2>> others,
    std::vector<bool> is_sharp)>;

/// An edge is a ridge when it is given, when other than two facets meet there, where
/// tags change, and where it is a sharp fold. A point of a ridge is a corner when it is
/// given, when other than two ridge edges meet there, where they turn by the ridge
/// angle or differ in tag, and on frozen facets.
/// @param choose decides on the folds, when it is given
[[nodiscard]] Features find_features(const SurfaceInput &input,
                                     const RidgeChoice &choose = {});

} // namespace anistar
