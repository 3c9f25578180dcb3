#include "volume/stars/facet_margins.h"

#include "base/parallel.h"

namespace anistar {
namespace {

/// The normals of jets that were fitted to the mesh made a third of this, on a torus
/// whose geometry had 14 facets around.
constexpr double curved_slack = .002;

} // namespace

FacetStar facet_star(const Triangulation<3> &mesh, HalfFacet h) {
  const Facet<3> t = mesh.facet(h);
  return {&mesh.vertex(t[0]), &mesh.vertex(t[1]), &mesh.vertex(t[2]),
          &mesh.vertex(mesh.apex(h)), &mesh.vertex(mesh.apex(mesh.opposite(h)))};
}

WallStar wall_star(const Triangulation<3> &mesh, const SurfaceNormals &normals,
                   const Facet<3> &facet, Index patch, std::array<Index, 2> apexes) {
  WallStar star;
  for (std::size_t k = 0; k < 3; ++k) {
    star.corners[k] = &mesh.vertex(facet[k]);
    star.normals[k] = normals.at(facet[k], patch);
  }
  for (std::size_t k = 0; k < 2; ++k)
    star.apexes[k] = apexes[k] == none ? nullptr : &mesh.vertex(apexes[k]);
  return star;
}

DecidingStar deciding_star(const Triangulation<3> &mesh, const SurfaceNormals &normals,
                           HalfFacet h) {
  const Index patch = mesh.constraint(h);
  if (patch == none)
    return facet_star(mesh, h);
  const HalfFacet beyond = mesh.opposite(h);
  return wall_star(mesh, normals, mesh.facet(h), patch,
                   {mesh.apex(h), beyond.exists() ? mesh.apex(beyond) : none});
}

double margin_of(const WallStar &star) {
  const double margin = wall_margin(star);
  return star.normals[0] ? margin + curved_slack : margin;
}

DecidingVertices::DecidingVertices(const Triangulation<3> &mesh, HalfFacet h) {
  const Facet<3> t = mesh.facet(h);
  vertices_ = {t[0], t[1], t[2], mesh.apex(h), none};
  if (const HalfFacet beyond = mesh.opposite(h); beyond.exists())
    vertices_[n_++] = mesh.apex(beyond);
}

void FacetMargins::fill(int threads) {
  parallel_ranges(mesh_.cells.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto c = static_cast<Index>(k);
      for (std::size_t i = 0; mesh_.is_alive(c) && i < 4; ++i) {
        const HalfFacet h(c, i);
        if (!mesh_.opposite(h).exists() || mesh_.opposite(h).cell() > c)
          look(h);
      }
    }
  });
}

void FacetMargins::forget(Index c) {
  for (std::size_t i = 0; i < 4; ++i) {
    const HalfFacet other = mesh_.opposite(HalfFacet(c, i));
    known_[c][i] = unknown;
    if (other.exists())
      known_[other.cell()][other.facet()] = unknown;
  }
}

} // namespace anistar
