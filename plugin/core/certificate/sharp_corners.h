#pragma once
// Where a certificate may fail: at corners so sharp that no arrangement of vertices
// passes.

#include "certificate/certificate.h"

namespace anistar {

/// The vertices without a certificate that may be: in the first shell of a corner below
/// 30 degrees, at most 8 for each. A corner lies between two walls that follow one
/// another around a vertex (2D) or an edge (3D) when they form a smaller angle; in 3D
/// also at a vertex where the walls leave a smaller solid angle than a cone with this
/// aperture.
/// @param star_ok per vertex, whether its star is certified.
template <std::size_t d>
[[nodiscard]] std::vector<std::uint8_t>
exempt_vertices(const CertifiedMesh<d> &mesh, std::span<const std::uint8_t> star_ok);

} // namespace anistar
