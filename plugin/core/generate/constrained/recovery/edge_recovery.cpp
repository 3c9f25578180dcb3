#include "generate/constrained/recovery/edge_recovery.h"

#include "base/errors.h"

#include <algorithm>
#include <numeric>
#include <string>

namespace anistar::generate {
namespace {

/// So many points within a facet that may flip are no sign of trouble.
constexpr Index points_per_facet = 4, points_per_triangle = 1;

Index popped(std::vector<Index> &stack) {
  const Index last = stack.back();
  stack.pop_back();
  return last;
}

} // namespace

EdgeRecovery::EdgeRecovery(ExactPoints &points, GhostMesh &mesh, FacetTriangles &facets,
                           RigidFacets &rigid)
    : points_(points), mesh_(mesh), facets_(facets), rigid_(rigid),
      may_place_(rigid.size(), points_per_facet), flips_(points, mesh, facets),
      rule_(points, mesh, facets), insertion_(points, mesh) {
  for (const FacetTriangles::Triangle &t : facets.triangles())
    may_place_[t.facet] += points_per_triangle;
}

bool EdgeRecovery::run(Monitor &monitor) {
  push_missing_edges();
  counts_.missing = segments_.size() + flat_.size();
  while (!segments_.empty() || !flat_.empty() || !deferred_.empty()) {
    monitor.insist(points_.size());
    if (!segments_.empty()) {
      const Index edge = popped(segments_);
      if (is_missing(edge))
        split(edge);
    } else if (!flat_.empty()) {
      const Index edge = popped(flat_);
      if (is_missing(edge) && !flip(edge))
        deferred_.push_back(edge);
    } else {
      const Index edge = popped(deferred_);
      if (!is_missing(edge) || flip(edge))
        continue;
      if (is_getting_too_many(edge))
        return false;
      split(edge);
    }
  }
  counts_.flips = flips_.n_flips();
  return true;
}

/// The longest come last: they are divided first, and spare others.
void EdgeRecovery::push_missing_edges() {
  const auto &edges = facets_.edges();
  std::vector<Index> order(edges.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](Index e) { return edges[e].from; });
  PerVertex<Index> neighbour_of(points_.size(), none);
  Index here = none;
  for (const Index e : order) {
    if (!edges[e].is_alive || !facets_.is_required(e))
      continue;
    if (edges[e].from != here) {
      here = edges[e].from;
      for (const Index c : mesh_.star(here))
        for (const Index v : mesh_.cell(c))
          if (v != ghost)
            neighbour_of[v] = here;
    }
    if (neighbour_of[edges[e].to] != here)
      push(e);
  }
  const auto length = [&](Index e) {
    return points_.squared_distance(edges[e].from, edges[e].to);
  };
  std::ranges::stable_sort(segments_, {}, length);
  std::ranges::stable_sort(flat_, {}, length);
}

bool EdgeRecovery::is_missing(Index edge) const {
  const FacetTriangles::Edge &e = facets_.edges()[edge];
  return e.is_alive && facets_.is_required(edge) && !mesh_.find_edge(e.from, e.to);
}

Index EdgeRecovery::facet_at(Index flat_edge) const {
  return facets_.triangles()[facets_.sides(flat_edge).front().triangle].facet;
}

bool EdgeRecovery::flip(Index edge) {
  if (rigid_[facet_at(edge)])
    return false;
  const std::vector<Index> required = flips_.flip_required(edge, points_);
  flat_.insert(flat_.end(), required.begin(), required.end());
  return !required.empty();
}

/// Whether a point on the edge is one too many for its facet, which becomes rigid then.
bool EdgeRecovery::is_getting_too_many(Index flat_edge) {
  const Index facet = facet_at(flat_edge);
  if (rigid_[facet] || --may_place_[facet] >= 0)
    return false;
  rigid_[facet] = true;
  return true;
}

void EdgeRecovery::split(Index edge) {
  const LinePart part = rule_.part_of(edge);
  const Line line = facets_.lines()[part.line];
  const double t = rule_.fraction(part);
  if (!(t > part.low && t < part.high))
    throw MeshingError("the edge from point " + std::to_string(line.from) +
                           " to point " + std::to_string(line.to) +
                           " stays missing, however finely it is divided",
                       points_.rounded(part.from));
  require_end(line);
  counts_.on_flat_lines += line.is_flat();
  const Index p = points_.add({line.from, line.to, t});
  mesh_.add_vertex();
  insertion_.insert(p, mesh_.cell_at(part.from));
  for (const Index half : facets_.split(edge, p))
    push(half);
  push_lost_edges();
}

/// Thin stacks of facets take a hundred points for each of theirs; what takes more by
/// far has facets that cross or touch.
void EdgeRecovery::require_end(const Line &line) const {
  constexpr std::size_t always = 100'000, per_point = 1'000;
  const auto n_given = static_cast<std::size_t>(points_.n_given());
  if (points_.steiner_points().size() > always + per_point * n_given)
    throw MeshingError("edges need more and more points, now from point " +
                           std::to_string(line.from) + " to point " +
                           std::to_string(line.to),
                       points_.rounded(line.from));
}

void EdgeRecovery::push_lost_edges() {
  for (const Cell<3> &cell : insertion_.removed())
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) {
        if (cell[i] == ghost || cell[j] == ghost)
          continue;
        const Index edge = facets_.find(cell[i], cell[j]);
        if (edge != none && facets_.is_required(edge))
          push(edge);
      }
}

} // namespace anistar::generate
