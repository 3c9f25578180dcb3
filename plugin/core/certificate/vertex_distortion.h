#pragma once
// How far the metric of a vertex is from those of its neighbours.

#include "certificate/certificate.h"

namespace anistar {

/// Per vertex the largest gamma(M_v, M_w) over its edges vw, at least 1.
template <std::size_t d>
[[nodiscard]] PerVertex<double> vertex_distortion(std::span<const Vertex<d>> vertices,
                                                  std::span<const Cell<d>> cells,
                                                  int threads, const Look &look);

} // namespace anistar
