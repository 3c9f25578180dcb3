#include "generate/constrained/recovery/facet_recovery.h"

#include "base/errors.h"

#include <algorithm>
#include <optional>
#include <string>

namespace anistar::generate {

FacetRecovery::Counts FacetRecovery::run(Monitor &monitor) {
  const auto by_plane = facets_.triangles_by_plane();
  for (std::size_t plane = 0; plane < by_plane.size(); ++plane) {
    monitor.insist(points_.size());
    plane_ = static_cast<Index>(plane);
    if (!by_plane[plane].empty())
      recover(by_plane[plane], monitor);
  }
  return counts_;
}

void FacetRecovery::recover(const std::vector<Index> &triangles, Monitor &monitor) try {
  if (!walk_.find_triangles(triangles)) {
    side_.start(facets_.planes()[plane_]);
    // every cavity adds to what is there of the facet and takes nothing away
    const std::size_t most_cavities = mesh_.n_cells();
    std::size_t n = 0;
    for (Index crossed = walk_.walk(triangles); crossed != none;
         crossed = walk_.walk(triangles)) {
      if (n++ == most_cavities)
        give_up("stays incomplete");
      carve(crossed, monitor);
    }
    counts_.missing += n > 0;
  }
  for (const HalfFacet h : walk_.found())
    mesh_.set_wall(h, plane_);
} catch (const LostEdge &edge) {
  give_up("has lost its edge from point " + std::to_string(edge.from) + " to point " +
          std::to_string(edge.to) + " to another facet");
}

void FacetRecovery::carve(Index crossed, Monitor &monitor) {
  const std::vector<Index> cavity = collect_cavity(crossed);
  ++counts_.cavities;
  counts_.largest_cavity = std::max(counts_.largest_cavity, cavity.size());
  auto [above, below] = halves(cavity);
  auto upper = wrapped(points_, side_, above, monitor);
  if (!upper)
    give_up("leaves a cavity above it that cannot be filled");
  for (const auto &[a, b, c] : upper->on_plane)
    below.border.push_back({a, c, b});
  const auto lower = wrapped(points_, side_, below, monitor);
  if (!lower)
    give_up("leaves a cavity below it that cannot be filled");
  counts_.rejections += upper->rejections + lower->rejections;
  upper->cells.insert(upper->cells.end(), lower->cells.begin(), lower->cells.end());
  if (!mesh_.replace(cavity, upper->cells))
    give_up("leaves a cavity that does not close");
}

bool FacetRecovery::is_crossed(HalfFacet h) {
  bool above = false, below = false;
  for (const Index v : mesh_.facet(h)) {
    if (v == ghost)
      return false;
    above |= side_.is_above(v);
    below |= side_.is_below(v);
  }
  return above && below;
}

std::vector<Index> FacetRecovery::collect_cavity(Index crossed) {
  std::vector<Index> cavity{crossed};
  in_cavity_.start(mesh_.n_slots());
  in_cavity_.visit(crossed);
  for (std::size_t k = 0; k < cavity.size(); ++k)
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(cavity[k], i);
      const Index next = mesh_.opposite(h).cell();
      if (in_cavity_.has(next) || !is_crossed(h))
        continue;
      if (mesh_.wall(h) != none)
        refuse_crossing(h);
      refuse_crossing_edges(h);
      if (mesh_.is_ghost(next))
        give_up("leaves the convex hull");
      in_cavity_.visit(next);
      cavity.push_back(next);
    }
  return cavity;
}

/// The parts of a cavity above and below the plane.
std::array<HalfCavity, 2> FacetRecovery::halves(const std::vector<Index> &cavity) {
  HalfCavity above{{}, {}, true}, below{{}, {}, false};
  std::vector<Index> vertices;
  for (const Index c : cavity) {
    const Cell<3> &cell = mesh_.cell(c);
    vertices.insert(vertices.end(), cell.begin(), cell.end());
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(c, i);
      if (in_cavity_.has(mesh_.opposite(h).cell()) && mesh_.wall(h) == none)
        continue;
      if (is_crossed(h))
        refuse_crossing(h);
      const Facet<3> facet = mesh_.facet(h);
      const bool is_above =
          std::ranges::any_of(facet, [&](Index v) { return side_.is_above(v); });
      (is_above ? above : below).border.push_back(facet);
    }
  }
  std::ranges::sort(vertices);
  vertices.erase(std::ranges::unique(vertices).begin(), vertices.end());
  for (const Index v : vertices) {
    if (!side_.is_below(v))
      above.vertices.push_back(v);
    if (!side_.is_above(v))
      below.vertices.push_back(v);
  }
  return {above, below};
}

/// An edge that is required and has its ends on both sides passes through the facet.
void FacetRecovery::refuse_crossing_edges(HalfFacet h) {
  const Facet<3> facet = mesh_.facet(h);
  for (std::size_t i = 0; i < 3; ++i) {
    const Index from = facet[i], to = facet[(i + 1) % 3];
    if (side_.is_on(from) || side_.is_on(to) || side_(from) == side_(to))
      continue;
    const Index edge = facets_.find(from, to);
    if (edge == none || !facets_.is_required(edge))
      continue;
    const auto sides = facets_.sides(edge);
    const Line &line = facets_.lines()[facets_.edges()[edge].line];
    refuse(sides.empty() ? "the edge from point " + std::to_string(line.from) +
                               " to point " + std::to_string(line.to)
                         : name_of(facets_.triangles()[sides.front().triangle].facet),
           (points_.rounded(from) + points_.rounded(to)) / 2);
  }
}

void FacetRecovery::refuse_crossing(HalfFacet h) const {
  Vector<3> middle = Vector<3>::Zero();
  for (const Index v : mesh_.facet(h))
    middle += points_.rounded(v) / 3;
  refuse(name_of(facets_.facets_of_planes()[mesh_.wall(h)]), middle);
}

void FacetRecovery::refuse(const std::string &other, const Vector<3> &place) const {
  throw MeshingError(name_of(facets_.facets_of_planes()[plane_]) + " crosses " + other,
                     place);
}

std::string FacetRecovery::name_of(Index facet) {
  return "facet " + std::to_string(facet);
}

void FacetRecovery::give_up(const std::string &why) const {
  throw MeshingError("facet " + std::to_string(facets_.facets_of_planes()[plane_]) +
                         " " + why,
                     points_.rounded(facets_.planes()[plane_][0]));
}

} // namespace anistar::generate
