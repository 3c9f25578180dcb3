#include "stars/bad_facets.h"

#include <algorithm>
#include <cmath>

namespace anistar {
namespace {

/// The length of the shortest edge of a facet in a metric.
template <std::size_t d>
double shortest_edge(const SymmetricTensor<d> &M, const SurfaceFacet<d> &facet) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = 0; j < i; ++j)
      least = std::min(least,
                       quadratic<d>(M, Vector<d>(facet.corners[i] - facet.corners[j])));
  return std::sqrt(least);
}

/// The first rule that an inconsistent facet breaks in the surface star of its vertex
/// k.
template <std::size_t d>
Rule broken_rule(const Triangulation<d> &mesh, const Background<d> &background,
                 const SeenFacet<d> &facet, std::size_t k,
                 const ConsistencyParameters &parameters) {
  const Index v = facet.vertices[k];
  const SymmetricTensor<d> &M = mesh.vertex(v).M;
  if (std::isfinite(facet.seen[k].shift)) {
    const Circumsphere<d> ball = surface_sphere<d>(M, facet.seen[k]);
    const double sf = sizing_field<d>(background, ball.centre, mesh.background_cell[v],
                                      parameters.gamma_0);
    if (ball.radius >= parameters.alpha_1 * sf)
      return Rule::facet_size;
    if (ball.radius > parameters.rho_0 * shortest_edge<d>(M, facet.seen[k]))
      return Rule::facet_radius_edge;
  }
  return Rule::facet_inconsistency;
}

} // namespace

template <std::size_t d> bool SurfaceStars<d>::is_consistent(std::size_t facet) const {
  return std::all_of(inside[facet].begin(), inside[facet].end(),
                     [](Index v) { return v == none; });
}

template <std::size_t d> double SurfaceStars<d>::failing_fraction() const {
  std::size_t n = 0;
  for (std::size_t f = 0; f < facets.size(); ++f)
    n += !is_consistent(f);
  return static_cast<double>(n) / static_cast<double>(facets.size() + 1);
}

template <std::size_t d>
std::vector<BadCell<d>>
bad_facets(const Triangulation<d> &mesh, const Background<d> &background,
           const SurfaceStars<d> &surface, const ConsistencyParameters &parameters) {
  std::vector<BadCell<d>> bad;
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    if (surface.is_consistent(f))
      continue;
    const SeenFacet<d> &facet = surface.facets[f];
    const auto &inside = surface.inside[f];
    const bool is_in_a_star =
        std::find(inside.begin(), inside.end(), none) != inside.end();
    const Index c = facet.at.cell();
    BadCell<d> found{c, mesh.at(c), Rule::kept, none, facet.at};
    for (std::size_t k = 0; k < d; ++k) {
      if (is_in_a_star && inside[k] != none)
        continue; // not in this star, but in another one
      const Rule rule = broken_rule<d>(mesh, background, facet, k, parameters);
      if (found.rule == Rule::kept || rule < found.rule) {
        found.rule = rule;
        found.star = facet.vertices[k];
      }
    }
    bad.push_back(found);
  }
  std::stable_sort(
      bad.begin(), bad.end(),
      [](const BadCell<d> &a, const BadCell<d> &b) { return a.rule < b.rule; });
  return bad;
}

template struct SurfaceStars<2>;
template struct SurfaceStars<3>;
template std::vector<BadCell<2>> bad_facets(const Triangulation<2> &,
                                            const Background<2> &,
                                            const SurfaceStars<2> &,
                                            const ConsistencyParameters &);
template std::vector<BadCell<3>> bad_facets(const Triangulation<3> &,
                                            const Background<3> &,
                                            const SurfaceStars<3> &,
                                            const ConsistencyParameters &);

} // namespace anistar
