#include "volume/stars/surface_normals.h"

#include "base/parallel.h"

#include <algorithm>
#include <tuple>

namespace anistar {
namespace {

/// A corner of a curved wall, and the normal of one such wall.
struct CurvedCorner {
  Index vertex, patch;
  Vector<3> of_wall;
};

std::vector<CurvedCorner> curved_corners(const Volume &volume) {
  const Triangulation<3> &mesh = volume.mesh;
  std::vector<CurvedCorner> found;
  for (std::size_t k = 0; k < mesh.cells.size(); ++k) {
    const auto c = static_cast<Index>(k);
    if (!mesh.is_alive(c) || !volume.is_walled(c))
      continue;
    for (std::size_t i = 0; i < 4; ++i) {
      const Index patch = mesh.constraint(HalfFacet(c, i));
      if (patch == none || volume.surface.patch(patch).is_planar)
        continue;
      const Facet<3> t = mesh.facet(HalfFacet(c, i));
      const Vector<3> a = mesh.vertex(t[0]).x,
                      area = (mesh.vertex(t[1]).x - a).cross(mesh.vertex(t[2]).x - a);
      for (Index v : t)
        found.push_back({v, patch, area});
    }
  }
  const auto place = [](const CurvedCorner &at) {
    return std::tie(at.vertex, at.patch);
  };
  std::stable_sort(found.begin(), found.end(), [&](const auto &one, const auto &other) {
    return place(one) < place(other);
  });
  const auto last =
      std::unique(found.begin(), found.end(), [&](const auto &one, const auto &other) {
        return place(one) == place(other);
      });
  found.erase(last, found.end());
  return found;
}

} // namespace

SurfaceNormals::SurfaceNormals(const Volume &volume, int threads)
    : begin_(volume.mesh.vertices.size() + 1, 0) {
  if (!volume.surface.is_curved())
    return;
  const std::vector<CurvedCorner> corners = curved_corners(volume);
  normals_.resize(corners.size());
  parallel_ranges(corners.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const auto &[v, patch, of_wall] = corners[k];
      normals_[k] = {patch,
                     volume.surface.normal(patch, volume.mesh.vertex(v).x, of_wall)};
    }
  });
  for (const CurvedCorner &corner : corners)
    ++begin_[corner.vertex + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
}

const Vector<3> *SurfaceNormals::at(Index v, Index patch) const {
  for (const Normal &normal : at(v))
    if (normal.patch == patch)
      return &normal.along;
  return nullptr;
}

} // namespace anistar
