#include "certificate/circumspheres.h"

#include "base/parallel.h"
#include "certificate/domain.h"

#include <mutex>

namespace anistar {
namespace {

/// One cell, in the metrics of its vertices.
struct Seen {
  double radius_edge = 0;
  double sliverity = std::numeric_limits<double>::infinity();
  std::uint8_t inside = 0; ///< bit k: its centre in the metric of vertex k is
};

template <std::size_t d>
Seen see(CertifiedMesh<d> mesh, const Domain<d> &domain, Index cell) {
  const Cell<d> &corners = mesh.cells[cell];
  Simplex<d> s;
  for (std::size_t k = 0; k <= d; ++k)
    s[k] = mesh.vertices[corners[k]].x;
  const double volume = anistar::volume<d>(s);
  Seen seen;
  Index near = cell; // the centres are not far from one another
  for (unsigned k = 0; k <= d; ++k) {
    const Vertex<d> &of = mesh.vertices[corners[k]];
    const double shortest = shortest_length<d>(of.M, s);
    const Circumsphere<d> sphere = circumsphere<d>(of.M, s);
    seen.radius_edge = std::max(seen.radius_edge, sphere.radius / shortest);
    seen.sliverity =
        std::min(seen.sliverity, sliverity<d>(volume / of.weight, shortest));
    if (domain.holds(sphere.centre, near))
      seen.inside = static_cast<std::uint8_t>(seen.inside | 1u << k);
  }
  return seen;
}

} // namespace

template <std::size_t d>
CircumsphereFigures circumsphere_figures(CertifiedMesh<d> mesh,
                                         std::span<const std::uint8_t> bits,
                                         int threads, const Look &look) {
  const std::size_t n = mesh.cells.size();
  const Domain<d> domain(mesh);
  CircumsphereFigures out{{std::vector<double>(n), std::vector<double>(n)}, {}};
  std::mutex adding;
  watched_ranges(n, threads, look, [&](std::size_t begin, std::size_t end) {
    RestrictedStars counts;
    for (std::size_t c = begin; c < end; ++c) {
      const Seen seen = see<d>(mesh, domain, static_cast<Index>(c));
      out.shapes.radius_edge[c] = seen.radius_edge;
      out.shapes.sliverity[c] = seen.sliverity;
      const bool is_inside = seen.inside == all_vertices<d>;
      const std::size_t ok = is_inside && bits[c] == all_vertices<d>;
      counts.v1 += {ok, is_inside};
      counts.v2 += {ok, seen.inside != 0};
    }
    const std::lock_guard lock(adding);
    out.restricted.v1 += counts.v1;
    out.restricted.v2 += counts.v2;
  });
  return out;
}

template CircumsphereFigures circumsphere_figures(CertifiedMesh<2>,
                                                  std::span<const std::uint8_t>, int,
                                                  const Look &);
template CircumsphereFigures circumsphere_figures(CertifiedMesh<3>,
                                                  std::span<const std::uint8_t>, int,
                                                  const Look &);

} // namespace anistar
