#pragma once
// The rules of Algorithms 2 and 4 of Boissonnat, Wormser, Yvinec (RR-7712 v2, sections
// 4.1 and 7.1), for meshes of triangles and of tetrahedra.

#include "certificate/certificate.h"
#include "mesh/statistics.h"
#include "mesh/triangulation.h"

namespace anistar {

/// The parameters of the paper, by their names there.
struct ConsistencyParameters {
  double alpha_0; ///< size of a cell: r >= alpha_0 sf
  double alpha_1; ///< the same for facets of surfaces
  double rho_0;   ///< radius-edge ratio
  double sigma_0; ///< sliverity
  double gamma_0; ///< distortion bound of the sizing field; infinite: off
  double delta;   ///< picking region: the ball of radius delta r about the circumcentre
  double beta;    ///< hitting sets count up to radius beta r
  int candidates; ///< points that pick_valid tries
  double max_growth;             ///< at most this fraction of vertices is added
  bool protecting_balls = false; ///< of ridges, see volume/pure/protecting_balls.h
};

/// Whether points are inserted until every star agrees; `pure` starts from the boundary
/// alone and applies nothing but the rules of the paper.
enum class ConsistencyMode { off, on, pure };

/// The rules of Algorithm 4 in their order; what breaks one is refined before what
/// breaks a later one. A facet has a topological defect when one of its vertices lies
/// on no surface: not in a mesh whose facets are given.
enum class Rule {
  kept,
  ridge_conformity, ///< before all others: an edge of a ridge that is encroached upon
  facet_size,
  facet_topology,
  facet_radius_edge,
  size,
  radius_edge,
  sliver,
  facet_inconsistency,
  inconsistency
};

[[nodiscard]] inline bool is_about_size(Rule rule) {
  return rule == Rule::facet_size || rule == Rule::facet_topology || rule == Rule::size;
}
[[nodiscard]] inline bool is_about_facets(Rule rule) {
  return rule == Rule::facet_size || rule == Rule::facet_topology ||
         rule == Rule::facet_radius_edge || rule == Rule::facet_inconsistency;
}

/// Why no round of insertions follows; `none_yet` while one does.
enum class ConsistencyStop {
  none_yet,
  consistent,
  stalled,
  no_mesh, ///< consistent stars, which are no mesh of the domain
  max_growth,
  max_rounds,
  max_vertices,
  max_seconds
};

struct ConsistencyCounts {
  std::size_t size = 0, radius_edge = 0, sliver = 0, inconsistency = 0;
  std::size_t facet_size = 0, facet_topology = 0, facet_radius_edge = 0,
              facet_inconsistency = 0;
  std::size_t boundary = 0; ///< points that were snapped to a surface (Algorithm 5)
  std::size_t moves = 0;    ///< of vertices, in 3D
  int rounds = 0;
  double ln_gamma_p90 = 0; ///< of the edges of the cells that fail in the end
  ConsistencyStop stop = ConsistencyStop::none_yet;

  void add(Rule rule) {
    switch (rule) {
    case Rule::facet_size:
      ++facet_size;
      break;
    case Rule::facet_topology:
      ++facet_topology;
      break;
    case Rule::facet_radius_edge:
      ++facet_radius_edge;
      break;
    case Rule::facet_inconsistency:
      ++facet_inconsistency;
      break;
    case Rule::size:
      ++size;
      break;
    case Rule::radius_edge:
      ++radius_edge;
      break;
    case Rule::sliver:
      ++sliver;
      break;
    case Rule::inconsistency:
      ++inconsistency;
      break;
    case Rule::kept:
    case Rule::ridge_conformity:
      break;
    }
  }
};

/// The distortion where cells fail: 10 % of their edges have a larger ln gamma; 0 when
/// none fails.
template <std::size_t d>
[[nodiscard]] double ln_gamma_p90(const Triangulation<d> &mesh,
                                  const std::vector<std::uint8_t> &bits) {
  std::vector<Cell<d>> failing;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    if (mesh.is_alive(static_cast<Index>(c)) && bits[c] != all_vertices<d>)
      failing.push_back(mesh.cells[c]);
  return failing.empty() ? 0 : distortion_quantiles(mesh.vertices, failing, 1).p90;
}

/// Certified fractions of a mesh.
struct CertifiedFractions {
  double simplex_ok =
      0;              ///< of the cells: Delaunay in the metrics of all their vertices
  double star_ok = 0; ///< of the stars: their cells are Delaunay in its metric
};

template <std::size_t d>
[[nodiscard]] CertifiedFractions
certified_fractions(const Triangulation<d> &mesh,
                    const std::vector<std::uint8_t> &bits) {
  std::vector<std::uint8_t> ok(mesh.vertices.size(), 1);
  std::size_t cells = 0, stars = 0, used = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    if (!mesh.is_alive(static_cast<Index>(c)))
      continue;
    cells += bits[c] == all_vertices<d>;
    for (std::size_t k = 0; k <= d; ++k)
      if ((bits[c] >> k & 1) == 0)
        ok[mesh.cells[c][k]] = 0;
  }
  for (std::size_t v = 0; v < ok.size(); ++v)
    if (mesh.is_used(static_cast<Index>(v))) {
      ++used;
      stars += ok[v];
    }
  return {static_cast<double>(cells) / static_cast<double>(mesh.n_cells()),
          static_cast<double>(stars) / static_cast<double>(used)};
}

/// The cells that are not Delaunay in the metrics of all their vertices.
template <std::size_t d>
[[nodiscard]] std::vector<Index> failing_cells(const Triangulation<d> &mesh,
                                               const std::vector<std::uint8_t> &bits) {
  std::vector<Index> cells;
  for (std::size_t c = 0; c < bits.size(); ++c)
    if (mesh.is_alive(static_cast<Index>(c)) && bits[c] != all_vertices<d>)
      cells.push_back(static_cast<Index>(c));
  return cells;
}

/// The part of the cells that is not Delaunay in the metrics of all its vertices.
template <std::size_t d>
[[nodiscard]] double failing_fraction(const Triangulation<d> &mesh,
                                      const std::vector<std::uint8_t> &bits) {
  std::size_t passing = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    passing += mesh.is_alive(static_cast<Index>(c)) && bits[c] == all_vertices<d>;
  return 1 - static_cast<double>(passing) / static_cast<double>(mesh.n_cells());
}

} // namespace anistar
