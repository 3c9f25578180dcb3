#pragma once
// Delaunay refinement of a constrained Delaunay tetrahedralisation: rules 1 to 3, the
// rules of Terminator 3D at small angles, and Li's elimination of slivers.
//
// Source: the course slides "The 3D meshing problem" (docs/refinement.md leads from
// each of them to the function here); Shewchuk, Mesh generation for domains with small
// angles (2000); Li, Sliver-free three dimensional Delaunay mesh generation (2000).
// Names and letters are those of the slides.

#include "base/monitor.h"
#include "generate/tetrahedralisation.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace anistar::generate {

/// What Li's method may choose, and the conditions of its theorem on that.
struct SliverSettings {
  bool are_eliminated;
  double least_dihedral; ///< in degrees; stands for sigma_0
  double delta;          ///< radius of the refinement regions, as a fraction
  double rho_0;          ///< slivers have a radius-edge ratio of at most this
  double C;              ///< small slivers a circumradius of at most C r_tau
  int n_picks;           ///< in a refinement region

  /// (1 - delta)^3 rho_0 / 2 >= 1 and (1 - delta)^3 C / 4 >= 1.
  [[nodiscard]] bool meet_conditions() const {
    const double shrink = (1 - delta) * (1 - delta) * (1 - delta);
    return shrink * rho_0 / 2 >= 1 && shrink * C / 4 >= 1;
  }
};

struct RefinementSettings {
  double bound; ///< B, the largest radius-edge ratio; the theorem asks for more than 2
  /// Of edges, as a fraction of the diagonal of the box around the points: nothing
  /// shorter is made, whatever the rules say.
  double shortest_edge;
  SliverSettings slivers;
  std::size_t max_vertices;
  double max_seconds;
  std::uint64_t seed;
};

/// The size wanted: empty, one for all, or one for each point of the input.
using Sizes = std::vector<double>;

/// Why something that a rule names was left as it is.
enum class Refusal : std::uint8_t {
  edge_not_longer,    ///< Terminator's rule 3: min r_w <= r_g
  facet_not_longer,   ///< Terminator's rule 2: r_v <= r_g
  acute_encroachment, ///< the point is on a facet that meets this one at an acute angle
  acute_shortest_edge, ///< of a tetrahedron: it joins two facets of an acute pair
  acute_facets,        ///< all vertices are on facets, two of which form an acute pair
  hidden_by_facet,     ///< the circumcentre is beyond a facet that it does not encroach
  hidden_by_edge,      ///< the same of a facet's, beyond an edge
  against_lemma,       ///< r_v < .7 r_p of a rejected p: its sphere is not empty
  no_cavity,           ///< no point tried has a cavity that its star fills
  too_short,           ///< it would make an edge below the floor
  no_pick,             ///< no pick in the refinement region helps against a sliver
};
inline constexpr std::size_t n_refusals = 11;
[[nodiscard]] std::string_view name_of(Refusal refusal);

/// r_v / r_p of points v whose parent p was rejected: the lemma says 1 / sqrt 2. Where
/// it is violated, for what is around is not Delaunay, v is refused.
struct LemmaCheck {
  std::size_t checked = 0, violated = 0;
  double least = std::numeric_limits<double>::infinity();

  /// Whether the ratio is as the lemma says.
  bool note(double ratio);
};

/// Points that the rules have inserted.
struct Insertions {
  std::size_t edges = 0, facets = 0, tetrahedra = 0;

  [[nodiscard]] std::size_t total() const { return edges + facets + tetrahedra; }
};

/// What is encroached in the mesh that is returned, and why.
struct Encroached {
  std::size_t edges = 0;
  std::size_t facets_across_acute_angle = 0; ///< only by a point of an acute partner
  std::size_t facets_not_longer = 0;         ///< by Terminator's rule 2
  std::size_t facets_otherwise = 0;          ///< no cavity, the floor, or a stop
};

struct RefinementRecord {
  Insertions refinement, sliver_elimination;
  std::array<std::size_t, n_refusals> refusals{};
  LemmaCheck edge_lemma;             ///< r_e >= .7 r_f
  LemmaCheck facet_lemma;            ///< r_f >= .7 r_t
  std::size_t enlarged_cavities = 0; ///< by round-off, at facets of the new point
  /// At edges, without cells that are hidden from the new point: see Cavity.
  std::size_t reduced_cavities = 0;
  /// Facets without a wall that are not locally Delaunay in the mesh that is returned,
  /// exactly: for these cavities, or for facets that are planar only nearly.
  std::size_t not_delaunay = 0;
  std::size_t clusters = 0, acute_pairs = 0;
  Encroached encroached;
  std::size_t above_bound = 0; ///< tetrahedra with a ratio above B that are left
  std::size_t slivers = 0;     ///< and those below the least dihedral angle
  double largest_ratio = 0, least_dihedral = 180;
  double l_1 = 0, l_2 = 0; ///< shortest edge before Li's phase, and the floor of it
  StopReason stop = StopReason::finished;
  double seconds_refining = 0, seconds_eliminating = 0;

  [[nodiscard]] std::size_t &of(Refusal refusal) {
    return refusals[static_cast<std::size_t>(refusal)];
  }
};

struct Refined {
  Tetrahedralisation mesh;
  RefinementRecord record;
};

/// Refines an exact constrained Delaunay tetrahedralisation. Points keep their place
/// and number, walls and edges their facets and segments.
/// @throws std::invalid_argument when walls do not bound the cells, or sizes do not fit
[[nodiscard]] Refined refine(const Tetrahedralisation &input, const Sizes &sizes,
                             const RefinementSettings &settings,
                             const Monitor::Progress &progress);

} // namespace anistar::generate
