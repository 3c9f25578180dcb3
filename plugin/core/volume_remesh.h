#pragma once
// remesh in 3D: a mesh, a metric field and a geometry in; a mesh with unit edges out.

#include "agreement_mode.h"
#include "consistency_rules.h"
#include "statistics.h"
#include "volume_passes.h"
#include "volume_start.h"

namespace anistar {

struct VolumeSettings {
  double hausdorff_number = .1; ///< of an edge, relative to its length
  std::size_t max_vertices = static_cast<std::size_t>(-1);
  double max_seconds = std::numeric_limits<double>::infinity();
  AgreementMode agreement = AgreementMode::when_possible;
  std::uint64_t seed = 0;
  int threads = 1;
  ConsistencyMode consistency = ConsistencyMode::off;
  ConsistencyParameters parameters{};
};

/// The new mesh as flat arrays, and what happened.
struct VolumeResult {
  std::vector<Vertex<3>> vertices;
  std::vector<Cell<3>> cells;
  std::vector<Index> cell_tags;
  std::vector<Facet<3>> facets; ///< boundary facets look outward
  std::vector<Index> facet_tags;
  std::vector<std::array<Index, 2>> edges; ///< the ridges that were given
  std::vector<Index> edge_tags;
  Statistics statistics;
  DistortionQuantiles distortion;
  bool was_checked = false;           ///< the certified fractions are known
  double simplex_ok = 0, star_ok = 0; ///< certified fractions
  std::string agreement;              ///< done, or why not
  ConsistencyCounts consistency;
  std::map<std::string, double> counts;
  std::map<std::string, double> seconds; ///< per phase
  StopReason reason = StopReason::finished;
};

/// @param background the input mesh with its metric
/// @throws std::invalid_argument, and what the progress callback throws
[[nodiscard]] VolumeResult
remesh_volume(const VolumeInput &input, std::span<const SymmetricTensor<3>> metric,
              const SurfaceInput &geometry, SurfaceProjection projection,
              const VolumeSettings &settings, Monitor::Progress progress);

} // namespace anistar
