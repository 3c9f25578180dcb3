#include "volume/stars/facet_margins.h"

#include "base/parallel.h"

namespace anistar {

FacetStar facet_star(const Triangulation<3> &mesh, HalfFacet h) {
  const Facet<3> t = mesh.facet(h);
  return {&mesh.vertex(t[0]), &mesh.vertex(t[1]), &mesh.vertex(t[2]),
          &mesh.vertex(mesh.apex(h)), &mesh.vertex(mesh.apex(mesh.opposite(h)))};
}

void FacetMargins::look(HalfFacet h) {
  if (!mesh_.opposite(h).exists() || mesh_.constraint(h) != none) {
    known_[h.cell()][h.facet()] = untested;
    return;
  }
  put(h, as_margin(facet_margin(facet_star(mesh_, h))));
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
