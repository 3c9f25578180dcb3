#pragma once
// What the remeshers of both dimensions return.

#include "base/monitor.h"
#include "mesh/statistics.h"
#include "stars/agreement.h"
#include "stars/rules.h"

#include <map>
#include <optional>
#include <string>

namespace anistar {

/// What the certificate found, cell by cell and star by star.
struct StarCounts {
  std::size_t failures = 0;                    ///< cells that failed at first
  std::size_t moves = 0;                       ///< of vertices, that mended some
  std::optional<CertifiedFractions> certified; ///< in the end; none: not asked
};

/// What happened, and how good the new mesh is.
struct RemeshRecord {
  Statistics statistics;
  double kept_quality = 0; ///< what no cell should be below (see kept_quality.h)
  DistortionQuantiles distortion;
  AgreementReport agreement;
  StarCounts stars;
  ConsistencyCounts consistency;
  std::map<std::string, double> seconds; ///< per phase
  StopReason reason = StopReason::finished;
};

/// The new mesh as flat arrays, and its record.
template <std::size_t d> struct RemeshResult : RemeshRecord {
  std::vector<Vertex<d>> vertices;
  std::vector<Cell<d>> cells;
  std::vector<Index> cell_tags;
  std::vector<Facet<d>> facets; ///< in 3D boundary facets look outward
  std::vector<Index> facet_tags;
  PerCell<std::uint8_t> delaunay; ///< see DelaunayBits; empty: not certified
};

} // namespace anistar
