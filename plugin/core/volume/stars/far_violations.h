#pragma once
// Vertices inside of the circumballs of cells, or of the surface balls of walls, that
// are no neighbours of theirs: no facet tells of them.

#include "certificate/surface/surface_stars.h"
#include "volume/stars/facet_margins.h"

#include <algorithm>
#include <unordered_map>

namespace anistar {

struct FarViolation {
  /// Those of a cell, in its order, or of a wall and none; then the one inside of a
  /// ball of it.
  std::array<Index, 5> vertices;
  Index patch = none; ///< of a wall

  bool operator==(const FarViolation &) const = default;
};

/// Each is watched like a facet: its five vertices decide about it in the same way.
class FarViolations {
public:
  void add(const FarViolation &found) {
    std::vector<FarViolation> &known = at_[found.vertices[0]];
    if (std::find(known.begin(), known.end(), found) != known.end())
      return;
    for (Index v : found.vertices)
      if (v != none)
        at_[v].push_back(found);
  }
  [[nodiscard]] bool empty() const { return at_.empty(); }
  /// Those with v among the five.
  [[nodiscard]] std::span<const FarViolation> at(Index v) const {
    if (at_.empty())
      return {};
    const auto found = at_.find(v);
    return found == at_.end() ? std::span<const FarViolation>() : found->second;
  }

private:
  std::unordered_map<Index, std::vector<FarViolation>> at_;
};

[[nodiscard]] inline DecidingStar star_of(const Triangulation<3> &mesh,
                                          const SurfaceNormals &normals,
                                          const FarViolation &violation) {
  const std::array<Index, 5> &v = violation.vertices;
  if (violation.patch != none)
    return wall_star(mesh, normals, {v[0], v[1], v[2]}, violation.patch, {v[4], none});
  FacetStar star;
  for (std::size_t k = 0; k < star.size(); ++k)
    star[k] = &mesh.vertex(v[k]);
  return star;
}

/// The walls of a mesh as the surface stars of their vertices see them, each once.
[[nodiscard]] std::vector<SeenFacet<3>> seen_walls(const Volume &volume,
                                                   const SurfaceNormals &normals);

/// A wall, and a vertex inside of a surface ball of it that it can reach (see
/// certificate/surface/surface_stars.h).
struct WallViolation {
  HalfFacet wall;
  Index inside;
};

/// One for each of these walls that is not in the surface stars of its vertices.
[[nodiscard]] std::vector<WallViolation>
wall_violations(const Triangulation<3> &mesh, const SurfaceNormals &normals,
                std::span<const HalfFacet> walls, int threads, const Look &look);

} // namespace anistar
