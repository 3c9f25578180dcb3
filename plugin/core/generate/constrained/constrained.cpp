#include "generate/constrained/constrained.h"

#include "generate/constrained/delaunay.h"
#include "generate/constrained/edge_recovery.h"
#include "generate/constrained/facet_recovery.h"
#include "generate/constrained/output.h"
#include "generate/constrained/regions.h"

namespace anistar::generate {

Constrained constrained_tetrahedralisation(const Plc &plc,
                                           const ConstrainedSettings &settings,
                                           Monitor &monitor) {
  ConstrainedCounts counts;
  monitor.enter("Delaunay mesh");
  ExactPoints points(plc.points);
  GhostMesh mesh = delaunay(points);

  monitor.enter("edges");
  FacetTriangles facets(plc);
  FacetFlips flips(points, mesh, facets);
  if (settings.facets_may_flip)
    flips.flip_missing_edges();
  facets.find_planes(points);
  EdgeRecovery edges(points, mesh, facets, settings.facets_may_flip ? &flips : nullptr);
  const auto [missing, on_flat_lines] = edges.run(monitor);
  counts.missing_edges = missing;
  counts.steiner_points = points.steiner_points().size();
  counts.steiner_points_in_facets = on_flat_lines;
  counts.flips = flips.n_flips();

  monitor.enter("facets");
  const auto recovered = FacetRecovery(points, mesh, facets).run(monitor);
  counts.missing_facets = recovered.missing;
  counts.cavities = recovered.cavities;
  counts.largest_cavity = recovered.largest_cavity;
  counts.rejections = recovered.rejections;

  monitor.enter("regions");
  PerCell<Index> regions = regions_of(points, mesh, facets, settings.regions);
  counts.predicates = points.counts().asked;
  counts.exact_predicates = points.counts().exact;
  return {output(points, mesh, facets, regions), counts};
}

} // namespace anistar::generate
