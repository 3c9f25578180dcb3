#pragma once
// remesh: a mesh, a metric field, and a geometry in; a mesh with unit edges out.

#include "agreement_mode.h"
#include "consistency.h"
#include "curves.h"
#include "monitor.h"
#include "shape.h"
#include "statistics.h"

#include <map>
#include <string>

namespace anistar {

struct RemeshSettings {
  ConsistencyMode consistency = ConsistencyMode::off;
  ConsistencyParameters parameters{};
  AgreementMode agreement = AgreementMode::when_possible;
  double hausdorff_number = .1; ///< of an edge, relative to its length
  std::size_t max_vertices = static_cast<std::size_t>(-1);
  double max_seconds = std::numeric_limits<double>::infinity();
  std::uint64_t seed = 0;
  int threads = 1;
};

/// The new mesh as flat arrays, and what happened.
struct RemeshResult {
  std::vector<Vertex<2>> vertices;
  std::vector<Cell<2>> cells;
  std::vector<Index> cell_tags;
  std::vector<Facet<2>> facets;
  std::vector<Index> facet_tags;
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
/// @param geometry the mesh whose facets are the shape
/// @throws std::invalid_argument, MeshingError, and what the progress callback throws
[[nodiscard]] RemeshResult remesh(const Background<2> &background,
                                  const GeometryInput &geometry,
                                  const Projection &projection,
                                  const RemeshSettings &settings,
                                  Monitor::Progress progress);

} // namespace anistar
