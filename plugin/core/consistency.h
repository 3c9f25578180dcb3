#pragma once
// Phase 6: Algorithms 1 to 3 of Boissonnat, Wormser, Yvinec (RR-7712 v2, section 4) on
// what agreement has left.

#include "agreement.h"
#include "star_check.h"

#include <string>

namespace anistar {

/// The parameters of the paper, by their names there.
struct ConsistencyParameters {
  double alpha_0; ///< rule 1: r >= alpha_0 sf
  double rho_0;   ///< rule 2: radius-edge ratio
  double sigma_0; ///< rule 3: sliverity
  double gamma_0; ///< distortion bound of the sizing field; infinite: off
  double delta;   ///< picking region: the ball of radius delta r about the circumcentre
  double beta;    ///< hitting sets count up to radius beta r
  int candidates; ///< points that pick_valid tries
  double max_growth; ///< at most this fraction of vertices is added
};

struct ConsistencyCounts {
  std::size_t size = 0, radius_edge = 0, sliver = 0, inconsistency = 0;
  std::size_t boundary = 0; ///< splits of encroached constrained edges
  int rounds = 0;
  std::string stop; ///< consistent, stalled, max_growth, max_rounds, or the monitor's
};

/// The distance l, in the metric at x, up to which the metric varies by at most
/// gamma_0: the bounded distortion radius (section 2.3), estimated from samples on
/// ellipses around x; the field is P1, so that samples at half the size of its cells
/// miss little.
[[nodiscard]] double bounded_distortion_radius(const Background<2> &background,
                                               const Vertex<2> &at, Index cell,
                                               double gamma_0);

/// Inserts points by the rules in their order until every star is Delaunay in its own
/// metric. With `relocate`, vertices are moved for agreement after every round of
/// insertions; without, only the rules of the paper act.
///
/// Differs from [1]: one valid mesh is kept instead of the star set; the simplices of
/// the star S_v are the cells that are Delaunay in M_v. Pick_valid takes the best of a
/// bounded number of points when none is valid. A round treats cells that share no
/// vertex. When it does not end consistent, the best mesh seen is left.
[[nodiscard]] ConsistencyCounts
refine_until_consistent(Workspace &w, Legaliser &legaliser, Monitor &monitor,
                        const ConsistencyParameters &parameters, std::uint64_t seed,
                        int threads, bool relocate, StarCheck &check);

} // namespace anistar
