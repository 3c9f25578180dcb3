#pragma once
// What the remeshers of both dimensions return.

#include "base/monitor.h"
#include "mesh/statistics.h"
#include "stars/rules.h"

#include <map>
#include <string>

namespace anistar {

/// The new mesh as flat arrays, and what happened.
template <std::size_t d> struct RemeshResult {
  std::vector<Vertex<d>> vertices;
  std::vector<Cell<d>> cells;
  std::vector<Index> cell_tags;
  std::vector<Facet<d>> facets; ///< in 3D boundary facets look outward
  std::vector<Index> facet_tags;
  Statistics statistics;
  double kept_quality = 0; ///< what no cell should be below (see kept_quality.h)
  DistortionQuantiles distortion;
  bool was_checked = false;           ///< the certified fractions are known
  double simplex_ok = 0, star_ok = 0; ///< certified fractions
  std::string agreement;              ///< done, or why not
  ConsistencyCounts consistency;
  std::map<std::string, double> counts;
  std::map<std::string, double> seconds; ///< per phase
  StopReason reason = StopReason::finished;
};

} // namespace anistar
