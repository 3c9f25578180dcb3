#include "stars/bad_cells.h"

#include "metric/bounded_distortion.h"

#include <algorithm>
#include <cmath>

namespace anistar {
namespace {

/// The first rule that a cell breaks in a star; `kept` when it keeps them all.
template <std::size_t d>
[[nodiscard]] Rule broken_rule(const Triangulation<d> &mesh,
                               const Background<d> &background, const Simplex<d> &s,
                               Index star, bool is_consistent,
                               const ConsistencyParameters &parameters) {
  const Vertex<d> &v = mesh.vertex(star);
  const Circumsphere<d> ball = circumsphere<d>(v.M, s);
  const double shortest = shortest_length<d>(v.M, s);
  const double sf = sizing_field<d>(background, ball.centre, mesh.background_cell[star],
                                    parameters.gamma_0);
  if (ball.radius >= parameters.alpha_0 * sf)
    return Rule::size;
  if (ball.radius / shortest > parameters.rho_0)
    return Rule::radius_edge;
  if (sliverity<d>(volume<d>(s) / v.weight, shortest) < parameters.sigma_0)
    return Rule::sliver;
  return is_consistent ? Rule::kept : Rule::inconsistency;
}

/// The first rule that a cell breaks in one of the stars that it is in.
template <std::size_t d>
[[nodiscard]] BadCell<d>
judge(const Triangulation<d> &mesh, const Background<d> &background, Index c,
      std::uint8_t bits, const ConsistencyParameters &parameters) {
  const Cell<d> &cell = mesh.at(c);
  const Simplex<d> s = mesh.simplex(c);
  BadCell<d> out{c, cell, Rule::kept, none};
  for (std::size_t k = 0; k <= d; ++k) {
    if (bits != 0 && (bits >> k & 1) == 0)
      continue; // not in this star, but in another one
    const Rule rule = broken_rule<d>(mesh, background, s, cell[k],
                                     bits == all_vertices<d>, parameters);
    if (rule != Rule::kept && (out.rule == Rule::kept || rule < out.rule)) {
      out.rule = rule;
      out.star = cell[k];
    }
  }
  return out;
}

} // namespace

template <std::size_t d>
double sizing_field(const Background<d> &background, const Vector<d> &centre,
                    Index background_cell, double gamma_0) {
  if (std::isinf(gamma_0))
    return 1;
  const Vertex<d> there = background.vertex(centre, background_cell);
  return std::min(
      1., bounded_distortion_radius<d>(background, there, background_cell, gamma_0));
}

template <std::size_t d>
std::vector<BadCell<d>>
bad_cells(const Triangulation<d> &mesh, const Background<d> &background,
          const std::vector<std::uint8_t> &bits,
          const ConsistencyParameters &parameters, bool everywhere) {
  std::vector<BadCell<d>> bad;
  for (std::size_t k = 0; k < mesh.cells.size(); ++k) {
    const auto c = static_cast<Index>(k);
    if (!mesh.is_alive(c) || (bits[k] == all_vertices<d> && !everywhere))
      continue;
    const BadCell<d> found = judge<d>(mesh, background, c, bits[k], parameters);
    if (found.rule != Rule::kept)
      bad.push_back(found);
  }
  std::stable_sort(
      bad.begin(), bad.end(),
      [](const BadCell<d> &a, const BadCell<d> &b) { return a.rule < b.rule; });
  return bad;
}

template double sizing_field(const Background<2> &, const Vector<2> &, Index, double);
template double sizing_field(const Background<3> &, const Vector<3> &, Index, double);
template std::vector<BadCell<2>> bad_cells(const Triangulation<2> &,
                                           const Background<2> &,
                                           const std::vector<std::uint8_t> &,
                                           const ConsistencyParameters &, bool);
template std::vector<BadCell<3>> bad_cells(const Triangulation<3> &,
                                           const Background<3> &,
                                           const std::vector<std::uint8_t> &,
                                           const ConsistencyParameters &, bool);

} // namespace anistar
