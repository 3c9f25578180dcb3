#include "volume/pure/star_set_mesh.h"

#include "volume/pure/initial_sites.h"
#include "volume/pure/protecting_balls.h"
#include "volume/pure/refinement.h"

namespace anistar {
namespace {

/// @throws BudgetSpent
void insert_all(std::span<const Site> sites, const Run &run, StarSet &stars) {
  for (const Site &site : sites) {
    run.monitor.insist(stars.size());
    if (!run.monitor.look(0)) // each takes a while
      throw BudgetSpent{};
    stars.insert(site);
  }
}

/// The sites that the star set begins with. @returns the edges of the ridges
std::vector<RidgeEdge> insert_first(const Volume &start, const Run &run,
                                    bool with_balls, StarSet &stars) {
  const DividedRidges divided =
      with_balls ? protected_ridges(start, run) : divided_ridges(start, run);
  insert_all(divided.sites, run, stars);
  insert_all(surface_sites(start), run, stars);
  return divided.edges;
}

} // namespace

StarSetMesh mesh_by_stars(const Volume &start, std::span<const Index> region,
                          const Run &run, const ConsistencyParameters &parameters) {
  StarSetMesh out;
  const DomainOracle domain(start, region);
  StarSet stars(domain);
  try {
    RidgeEdges ridges(insert_first(start, run, parameters.protecting_balls, stars));
    RefinedStarSet refined = refine_star_set(stars, ridges, run, parameters);
    out.counts = refined.counts;
    out.merged = std::move(refined.merged);
  } catch (const BudgetSpent &) {
    out.counts.stop =
        run.is_stopped() ? ConsistencyStop::max_seconds : ConsistencyStop::max_vertices;
  }
  out.n_sites = stars.size();
  return out;
}

} // namespace anistar
