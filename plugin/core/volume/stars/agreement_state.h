#pragma once
// What agreement knows of a volume mesh.

#include "volume/stars/facet_margins.h"
#include "volume/stars/far_violations.h"

namespace anistar {

/// For all threads. What belongs to cells and vertices of a slab is changed by the
/// thread that changes these.
struct AgreementState {
  AgreementState(const Volume &volume, int threads)
      : normals(volume, threads), margins(volume.mesh, normals),
        is_stuck(volume.mesh.vertices.size(), 0) {}
  AgreementState(const AgreementState &) = delete; // margins refer to normals
  AgreementState &operator=(const AgreementState &) = delete;

  SurfaceNormals normals;
  FacetMargins margins;
  FarViolations far;
  /// Vertices that found no directed step, and whose stars have not changed since.
  PerVertex<std::uint8_t> is_stuck;

  /// For cells and vertices that were added to the mesh.
  void extend(const Triangulation<3> &mesh) {
    margins.extend();
    is_stuck.resize(mesh.vertices.size(), 0);
  }
};

/// What one thread sees of it, and of the mesh.
struct AgreementView {
  Volume &volume;
  AgreementState &state;
  double hausdorff_number;         ///< of curved surfaces, relative to an edge
  std::vector<Index> changed{};    ///< cells, some of them more than once
  std::ptrdiff_t more_failing = 0; ///< facets, by the moves made
};

/// The quality below which nothing may fall that was not below before.
inline constexpr double agreement_floor = .5;

} // namespace anistar
