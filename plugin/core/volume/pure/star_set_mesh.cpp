#include "volume/pure/star_set_mesh.h"

#include "volume/pure/initial_sites.h"
#include "volume/pure/protecting_balls.h"
#include "volume/pure/refinement.h"

namespace anistar {
namespace {

/// @returns whether the budgets allowed all of them
bool insert_all(std::span<const Site> sites, const Run &run, StarSet &stars) {
  for (std::size_t k = 0; k < sites.size(); ++k) {
    if (!run.look(k, sites.size()))
      return false;
    stars.insert(sites[k]);
  }
  return true;
}

} // namespace

StarSetMesh mesh_by_stars(const Volume &start, std::span<const Index> region,
                          const Run &run, const ConsistencyParameters &parameters) {
  StarSetMesh out;
  const DomainOracle domain(start, region);
  StarSet stars(domain);
  const DividedRidges divided = parameters.protecting_balls
                                    ? protected_ridges(start, run)
                                    : divided_ridges(start, run);
  if (!insert_all(divided.sites, run, stars) ||
      !insert_all(surface_sites(start), run, stars)) {
    out.counts.stop = ConsistencyStop::max_seconds;
    return out;
  }
  RidgeEdges ridges(divided.edges);
  RefinedStarSet refined = refine_star_set(stars, ridges, run, parameters);
  out.counts = refined.counts;
  out.merged = std::move(refined.merged);
  out.n_sites = stars.size();
  return out;
}

} // namespace anistar
