#pragma once
// How far a smooth surface lies from the facets that sample it.

#include "surface/surface_features.h"

namespace anistar {

/// For every facet, from the turns at the edges around it (see chord_sag.h): half the
/// second fundamental form, which each turn adds to along its own direction
/// (Grinspun, Gingold, Reisman, Zorin, Computing discrete shape operators on general
/// meshes, 2006, section 4), beside its linear interpolation; and the sags of the
/// ridges that it touches. Frozen facets have none.
[[nodiscard]] std::vector<double> surface_sags(const SurfaceInput &input,
                                               const Features &features);

} // namespace anistar
