#pragma once
// Phase 5 in 3D: vertices are moved at the few failures of the certificate that no test
// on one facet can see.

#include "base/run.h"
#include "certificate/certificate.h"
#include "volume/mesh/volume.h"

namespace anistar {

/// The mesh as the certificate sees it.
[[nodiscard]] inline CertifiedMesh<3> certified(const Triangulation<3> &mesh) {
  return {mesh.vertices, mesh.cells, mesh.neighbours, mesh.constraints};
}

/// Moves vertices such that fewer cells fail; no more facets fail then, no quality
/// falls below agreement_floor and no edge becomes worse.
/// @param known the answers for the mesh, before and after
/// @returns the number of moves
std::size_t mend_stars(Volume &volume, Monitor &monitor, double hausdorff_number,
                       Seed seed, DelaunayBits &known);

} // namespace anistar
