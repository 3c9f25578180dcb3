#include "volume/stars/facet_repair.h"

#include "volume/mesh/vertex_star.h"
#include "volume/mesh/vertex_trial.h"

namespace anistar {
namespace {

/// Longer rings gain nothing and cost the square of their length.
constexpr std::size_t longest_ring = 8;
/// Edges that a re-insertion or a collapse may make.
constexpr double longest_made = 1.65;
/// Edges shorter than this may be collapsed, longer ones split.
constexpr double collapsible = .95, splittable = .95;
/// Places tried for an inserted vertex: the middle of the edge, then random ones within
/// this metric distance of it.
constexpr int n_insertions = 4;
constexpr double insertion_radius = .25;
constexpr double least_gain = 1e-7;

} // namespace

AgreementCost FacetRepair::cost_of(std::span<const Index> cells) {
  const Triangulation<3> &mesh = volume_.mesh;
  AgreementCost cost;
  for (Index c : cells) {
    cost.add_cell(volume_.quality_of(c));
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(c, i), other = mesh.opposite(h);
      const bool is_second =
          other.exists() && other.cell() < c && volume_.is_marked_cell(other.cell());
      if (!is_second)
        cost.add_facet(static_cast<double>(view_.state.margins.at(h)));
    }
  }
  return cost;
}

AgreementCost FacetRepair::cost_of_proposal() const {
  AgreementCost cost;
  operator_.for_new_cells([&](double quality, Index) { cost.add_cell(quality); });
  operator_.for_new_facets([&](const std::array<Index, 5> &v) {
    FacetStar star;
    for (std::size_t k = 0; k < 5; ++k)
      star[k] = &volume_.mesh.vertex(v[k]);
    cost.add_facet(facet_margin(star));
  });
  operator_.for_new_walls([&](const Facet<3> &facet, Index patch,
                              std::array<Index, 2> apexes) {
    cost.add_facet(
        margin_of(wall_star(volume_.mesh, view_.state.normals, facet, patch, apexes)));
  });
  return cost;
}

bool FacetRepair::is_worth_it(std::span<const Index> cells, Demand demand) {
  // the marks of the proposal may be gone
  volume_.open_cells();
  for (Index c : cells)
    volume_.mark_cell(c);
  const AgreementCost before = cost_of(cells), after = cost_of_proposal();
  if (after.failing > before.failing)
    return false;
  if (demand == Demand::fewer_failing || after.failing < before.failing)
    return after.failing < before.failing &&
           after.shortfall <= before.shortfall + least_gain;
  return after.total() < before.total() - least_gain;
}

bool FacetRepair::replace(std::span<const Index> cells, Index apex,
                          std::array<Index, 2> lost, const Acceptance &acceptance,
                          Demand demand) {
  if (!operator_.propose(cells, apex, lost, acceptance) || !is_worth_it(cells, demand))
    return false;
  operator_.commit(cells);
  AgreementState &state = view_.state;
  state.extend(volume_.mesh);
  operator_.for_new_cells([&](double, Index c) {
    state.margins.forget(c);
    view_.changed.push_back(c);
    for (Index v : volume_.mesh.at(c))
      state.is_stuck[v] = 0;
  });
  return true;
}

bool FacetRepair::swap(HalfFacet facet, Demand demand) {
  if (volume_.mesh.constraint(facet) != none)
    return swap_wall(facet, demand);
  if (into_edge(facet, demand))
    return true;
  const Facet<3> t = volume_.mesh.facet(facet);
  for (std::size_t k = 0; k < 3; ++k)
    if (remove_edge(facet.cell(), t[k], t[(k + 1) % 3], demand))
      return true;
  return false;
}

/// The apexes of a wall change with the facets and edges of its cells, the wall itself
/// with its own edges.
bool FacetRepair::swap_wall(HalfFacet wall, Demand demand) {
  const Triangulation<3> &mesh = volume_.mesh;
  for (const HalfFacet side : {wall, mesh.opposite(wall)}) {
    if (!side.exists())
      continue;
    const Cell<3> cell = mesh.at(side.cell());
    for (std::size_t i = 0; i < 4; ++i)
      if (const HalfFacet h(side.cell(), i);
          i != side.facet() && mesh.constraint(h) == none && into_edge(h, demand))
        return true;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        if (remove_edge(side.cell(), cell[i], cell[j], demand))
          return true;
  }
  return false;
}

/// The facet becomes an edge between its apexes.
bool FacetRepair::into_edge(HalfFacet facet, Demand demand) {
  const Triangulation<3> &mesh = volume_.mesh;
  const std::array<Index, 2> both{facet.cell(), mesh.opposite(facet).cell()};
  return replace(both, mesh.apex(facet), {none, none},
                 {.floor = agreement_floor, .gain = 0}, demand);
}

bool FacetRepair::remove_edge(Index c, Index a, Index b, Demand demand) {
  const auto walls = walls_of_removable(volume_, c, a, b, longest_ring, shell_);
  if (!walls)
    return false;
  for (std::size_t k = 0; k < shell_.n_ring(); ++k) {
    if (!walls->admits_apex(k))
      continue;
    if (replace(shell_.all(), shell_.ring[k], {a, b},
                {.floor = agreement_floor,
                 .gain = 0,
                 .hausdorff_number = view_.hausdorff_number},
                demand))
      return true;
  }
  return false;
}

bool FacetRepair::reinsert(Index v) {
  if (volume_.feature(v) == Triangulation<3>::corner)
    return false;
  star_of(volume_, v, star_);
  const std::size_t n_star = star_.size();
  grow_cavity(volume_, v, star_);
  return star_.size() != n_star &&
         replace(star_, v, {none, none},
                 {.floor = agreement_floor, .gain = 0, .longest = longest_made},
                 Demand::lower_cost);
}

/// Into the edge vu; only vertices inside of the domain vanish.
bool FacetRepair::collapse(Index v, Index u) {
  if (volume_.feature(v) != Triangulation<3>::interior)
    return false;
  star_of(volume_, v, star_);
  if (!replace(star_, u, {v, none},
               {.floor = agreement_floor, .gain = 0, .longest = longest_made},
               Demand::fewer_failing))
    return false;
  volume_.remove_vertex(v);
  return true;
}

/// Splits the edge ab, if it is inside of the domain.
bool FacetRepair::insert(Index c, Index a, Index b, CounterRandom &random) {
  if (!monitor_.has_room(volume_.n_vertices()) ||
      !shell_of(volume_.mesh, c, a, b, shell_) || !shell_.is_closed ||
      feature_of(volume_, shell_).dimension != Triangulation<3>::interior)
    return false;
  const Vertex<3> p = volume_.mesh.vertex(a), q = volume_.mesh.vertex(b);
  const Matrix<3> L = lower_factor<3>(p.M);
  for (int k = 0; k < n_insertions; ++k) {
    Vector<3> x = .5 * (p.x + q.x);
    if (k > 0)
      x += in_space(L, insertion_radius * random_in_ball(random));
    Index at = volume_.mesh.background_cell[a];
    const Vertex<3> vertex = volume_.background.vertex(x, at);
    const Index v = volume_.add_vertex(vertex, Triangulation<3>::interior, none, at);
    const std::span<const Index> shell = shell_.all();
    star_.assign(shell.begin(), shell.end());
    if (k % 2 == 1) {
      volume_.open_cells();
      for (Index cell : star_)
        volume_.mark_cell(cell);
      grow_cavity(volume_, v, star_);
    }
    if (replace(star_, v, {a, b}, {.floor = agreement_floor, .gain = 0},
                Demand::fewer_failing))
      return true;
    volume_.remove_vertex(v);
  }
  return false;
}

bool FacetRepair::collapse_or_insert(HalfFacet facet, CounterRandom &random) {
  const Triangulation<3> &mesh = volume_.mesh;
  const std::array<HalfFacet, 2> sides{facet, mesh.opposite(facet)};
  // both cells have the three edges of the facet: the second brings three more
  for (HalfFacet side : sides) {
    if (!side.exists())
      continue;
    const Cell<3> cell = mesh.at(side.cell());
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        if (i != j &&
            fast_length(mesh.vertex(cell[i]), mesh.vertex(cell[j])) < collapsible &&
            collapse(cell[i], cell[j]))
          return true;
  }
  for (HalfFacet side : sides) {
    if (!side.exists())
      continue;
    const Cell<3> cell = mesh.at(side.cell());
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        if (fast_length(mesh.vertex(cell[i]), mesh.vertex(cell[j])) > splittable &&
            insert(side.cell(), cell[i], cell[j], random))
          return true;
  }
  return false;
}

} // namespace anistar
