#include "generate/constrained/constrained.h"

#include "generate/constrained/complex.h"
#include "generate/constrained/flat/flat_cells.h"
#include "generate/constrained/mesh/delaunay.h"
#include "generate/constrained/output.h"
#include "generate/constrained/recovery/edge_recovery.h"
#include "generate/constrained/recovery/facet_recovery.h"
#include "generate/constrained/regions/regions.h"

#include <algorithm>
#include <memory>

namespace anistar::generate {
namespace {

/// The points that must be vertices of the mesh.
std::vector<Index> points_in_use(const Plc &plc, const std::vector<Index> &kept) {
  const std::vector<bool> is_used = used_points(plc, kept);
  std::vector<Index> used;
  for (std::size_t v = 0; v < is_used.size(); ++v)
    if (is_used[v])
      used.push_back(static_cast<Index>(v));
  return used;
}

/// Facets are made rigid so often until all of them are.
constexpr int most_attempts = 12;

/// The complex with its Delaunay mesh, of which all edges of the complex are edges.
std::unique_ptr<Complex> with_edges(const Plc &plc, const ConstrainedSettings &settings,
                                    ConstrainedCounts &counts, Monitor &monitor) {
  monitor.enter("Delaunay mesh");
  const ExactPoints given(plc.points);
  const GhostMesh start = delaunay(given, points_in_use(plc, settings.kept_points));
  Index n_facets = 0;
  for (const Index facet : plc.triangle_facets)
    n_facets = std::max(n_facets, facet + 1);
  RigidFacets rigid(n_facets, !settings.facets_may_flip);

  monitor.enter("edges");
  for (int attempt = 1;; ++attempt) {
    if (attempt == most_attempts)
      rigid.assign(rigid.size(), true);
    auto complex =
        std::make_unique<Complex>(ExactPoints(plc.points), start, FacetTriangles(plc));
    auto &[points, mesh, facets] = *complex;
    FacetFlips flips(points, mesh, facets);
    if (settings.facets_may_flip)
      flips.flip_missing_edges();
    facets.find_planes(points);
    EdgeRecovery edges(points, mesh, facets, rigid);
    if (!edges.run(monitor))
      continue;
    counts.missing_edges = edges.counts().missing;
    counts.steiner_points = points.steiner_points().size();
    counts.steiner_points_in_facets = edges.counts().on_flat_lines;
    counts.flips = flips.n_flips() + edges.counts().flips;
    counts.rigid_facets = static_cast<std::size_t>(std::ranges::count(rigid, true));
    return complex;
  }
}

} // namespace

Constrained constrained_tetrahedralisation(const Plc &plc,
                                           const ConstrainedSettings &settings,
                                           Monitor &monitor) {
  ConstrainedCounts counts;
  const auto complex = with_edges(plc, settings, counts, monitor);
  auto &[points, mesh, facets] = *complex;

  monitor.enter("facets");
  const auto recovered = FacetRecovery(points, mesh, facets).run(monitor);
  counts.missing_facets = recovered.missing;
  counts.cavities = recovered.cavities;
  counts.largest_cavity = recovered.largest_cavity;
  counts.rejections = recovered.rejections;

  monitor.enter("regions");
  PerCell<Index> regions = regions_of(points, mesh, facets, settings.regions);

  monitor.enter("flat cells");
  const auto flat = FlatCells(points, mesh, facets, regions)
                        .remove(settings.facets_may_flip, monitor);
  counts.peeled = flat.peeled;
  counts.removed = flat.swapped;
  counts.moved = flat.moved;
  counts.steiner_points_in_volumes = flat.inserted;
  counts.flat_left = flat.left;
  counts.flat_on_flat_walls = flat.on_flat_walls;
  counts.predicates = points.counts().asked;
  counts.exact_predicates = points.counts().exact;
  return {output(points, mesh, facets, regions), counts};
}

} // namespace anistar::generate
