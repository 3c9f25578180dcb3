// Li's elimination of slivers: new points are picked in refinement regions so that they
// form no small sliver, that is avoid the forbidden tori of all triangles around.

#include "generate/refinement/rules/rules.h"

#include <algorithm>

namespace anistar::generate {
namespace {

/// The theorem that wants a small delta says nothing of acute facets. Measured on
/// wedges and books of sizes .03 to .2: with .1 some slivers stay, with .5 points are
/// put too near to others.
constexpr double wedge_delta = .3;

} // namespace

/// Where a pick lies in a forbidden torus: the cosine of the least dihedral angle among
/// the tetrahedra that it forms with a circumradius of at most C r_tau. Larger slivers
/// are no concern: refining them makes no edge shorter than l_2.
double Rules::small_sliver_cosine(const Site &site, double r_tau) const {
  double largest = -1;
  for (HalfFacet h : cavity_.boundary()) {
    const Facet<3> f = mesh_.facet(h);
    const Simplex<3> cell{mesh_.points[f[0]], mesh_.points[f[1]], mesh_.points[f[2]],
                          site.x};
    if (circumscribed_ball(cell).radius <= pick_rule_.C * r_tau)
      largest = std::max(largest, largest_dihedral_cosine(cell));
  }
  return largest;
}

double Rules::cavity_cosine() const {
  double largest = -1;
  for (Index c : cavity_.cells())
    largest = std::max(largest, largest_dihedral_cosine(mesh_.simplex(c)));
  return largest;
}

bool Rules::is_sliver(Index t) const {
  return largest_dihedral_cosine(mesh_.simplex(t)) > pick_rule_.sliver_cosine;
}

/// Whether its least dihedral angle is below half of the least angle of the acute pairs
/// of facets that its vertices are on: that is not for the geometry's sake.
bool Rules::is_flatter_than_its_wedge(Index t) const {
  const Cell<3> &cell = mesh_.cells[t];
  std::optional<double> cosine;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      cosine = std::max(cosine, faces_.cosine_between(mesh_.carriers[cell[i]],
                                                      mesh_.carriers[cell[j]]));
  return cosine &&
         largest_dihedral_cosine(mesh_.simplex(t)) > std::sqrt(.5 * (1 + *cosine));
}

void Rules::begin_sliver_elimination() {
  const SliverSettings &slivers = settings_.slivers;
  double l_1 = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
    if (mesh_.is_alive(static_cast<Index>(c)))
      l_1 = std::min(l_1, shape_of(static_cast<Index>(c)).shortest);
  const double shrink = 1 - slivers.delta;
  record_.l_1 = l_1;
  record_.l_2 = shrink * shrink * shrink * l_1 / 4;
  floor_ = std::max(floor_, record_.l_2);
  constexpr double degree = std::numbers::pi / 180;
  pick_rule_ = {slivers.delta, slivers.n_picks, true,
                elementary::sine_cosine(slivers.least_dihedral * degree).cosine,
                slivers.C};
  wedge_pick_rule_ = pick_rule_;
  wedge_pick_rule_.delta = wedge_delta;
  insertions_ = &record_.sliver_elimination;
  eliminates_slivers_ = true;
  for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
    if (mesh_.is_alive(static_cast<Index>(c)))
      consider_cell(static_cast<Index>(c));
}

/// Rule 4: slivers, the flattest first.
bool Rules::apply_rule_4() {
  const std::optional<Index> t = queues_.slivers.pop(mesh_);
  if (!t)
    return false;
  if (conditionally_refine_tet(*t) == Outcome::elsewhere && mesh_.is_alive(*t))
    consider_cell(*t);
  return true;
}

} // namespace anistar::generate
