// What the report says of a refined mesh.

#include "generate/refinement/rules/rules.h"

#include <algorithm>

namespace anistar::generate {
namespace {

/// 1 / sqrt 2 but for round-off and the flatness of facets.
constexpr double least_lemma_ratio = .7;

} // namespace

std::string_view name_of(Refusal refusal) {
  switch (refusal) {
  case Refusal::edge_not_longer:
    return "edge_not_longer";
  case Refusal::facet_not_longer:
    return "facet_not_longer";
  case Refusal::acute_encroachment:
    return "acute_encroachment";
  case Refusal::acute_shortest_edge:
    return "acute_shortest_edge";
  case Refusal::acute_facets:
    return "acute_facets";
  case Refusal::hidden_by_facet:
    return "hidden_by_facet";
  case Refusal::hidden_by_edge:
    return "hidden_by_edge";
  case Refusal::against_lemma:
    return "against_lemma";
  case Refusal::no_cavity:
    return "no_cavity";
  case Refusal::too_short:
    return "too_short";
  case Refusal::no_pick:
    return "no_pick";
  }
  return "";
}

bool LemmaCheck::note(double ratio) {
  const bool holds = ratio >= least_lemma_ratio;
  ++checked;
  violated += !holds;
  least = std::min(least, ratio);
  return holds;
}

void Rules::finish_record() {
  Encroached &encroached = record_.encroached;
  for (const auto &[edge, segment] : mesh_.sorted_subsegments())
    encroached.edges += exists(edge) && is_encroached(edge);
  mesh_.for_each_wall([&](HalfFacet f, Index facet) {
    bool is_across = false;
    for (HalfFacet side : {f, mesh_.opposite(f)})
      if (side.exists() && is_encroached_by(f, mesh_.apex(side)))
        is_across = is_across || faces_.is_across_acute_angle(
                                     mesh_.carriers[mesh_.apex(side)], facet);
    const Index p = encroaching_apex(f);
    if (p == none)
      encroached.facets_across_acute_angle += is_across;
    else if (diametral_ball_of(f).radius <= mesh_.insertion_radius[p])
      ++encroached.facets_not_longer;
    else
      ++encroached.facets_otherwise;
  });
  double cosine = -1;
  constexpr double degree = std::numbers::pi / 180;
  const double sliver_cosine =
      elementary::sine_cosine(settings_.slivers.least_dihedral * degree).cosine;
  for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
    if (!mesh_.is_alive(static_cast<Index>(c)))
      continue;
    const double ratio = shape_of(static_cast<Index>(c)).ratio();
    record_.above_bound += ratio > settings_.bound;
    record_.largest_ratio = std::max(record_.largest_ratio, ratio);
    const double of_cell =
        largest_dihedral_cosine(mesh_.simplex(static_cast<Index>(c)));
    record_.slivers += of_cell > sliver_cosine;
    cosine = std::max(cosine, of_cell);
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(static_cast<Index>(c), i), other = mesh_.opposite(h);
      record_.not_delaunay +=
          other.exists() && h < other && mesh_.wall(h) == none &&
          in_sphere(mesh_.simplex(h.cell()), mesh_.points[mesh_.apex(other)]) ==
              Side::inside;
    }
  }
  const double sine = std::sqrt(std::max(0., 1 - cosine * cosine));
  record_.least_dihedral = elementary::angle_of(sine, cosine) / degree;
}

} // namespace anistar::generate
