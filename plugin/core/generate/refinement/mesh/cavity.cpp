#include "generate/refinement/mesh/cavity.h"

#include "generate/refinement/mesh/spheres.h"

#include <algorithm>
#include <limits>

namespace anistar::generate {
namespace {

bool is_open(const Site &site, Index facet) {
  return std::find(site.open_facets.begin(), site.open_facets.end(), facet) !=
         site.open_facets.end();
}

/// The cell that the point would make with a half-facet of a cell of the cavity.
Simplex<3> cell_with(const WalledMesh &mesh, HalfFacet h, const Vector<3> &x) {
  const Facet<3> f = mesh.facet(h);
  return {mesh.points[f[0]], mesh.points[f[1]], mesh.points[f[2]], x};
}

/// Whether the point is on the side of the cell, strictly.
bool is_seen(const WalledMesh &mesh, HalfFacet h, const Vector<3> &x) {
  return orientation<3>(cell_with(mesh, h, x)) == Orientation::positive;
}

constexpr std::array<std::array<std::size_t, 2>, 6> edges_of_cell{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

} // namespace

CavityFlaw Cavity::gather(WalledMesh &mesh, const Site &site) {
  // Without walls near, what the spheres say is all seen; with walls, a cell may be
  // reached around one. A second look then goes only where the point can see.
  for (const bool only_visible : {false, true}) {
    start(mesh);
    flood(mesh, site, only_visible);
    find_boundary(mesh, site);
    if (!is_star_shaped(mesh, site))
      continue;
    const CavityFlaw flaw = flaw_of_star(mesh, site);
    if (flaw == CavityFlaw::buries_subsegment && site.may_leave_hidden)
      break;
    return flaw;
  }
  if (!site.may_leave_hidden || !leave_hidden(mesh, site))
    return CavityFlaw::not_star_shaped;
  return flaw_of_star(mesh, site);
}

CavityFlaw Cavity::flaw_of_star(const WalledMesh &mesh, const Site &site) {
  if (const CavityFlaw flaw = what_is_buried(mesh, site); flaw != CavityFlaw::no_flaw)
    return flaw;
  return find_rims(mesh) ? CavityFlaw::no_flaw : CavityFlaw::folds_facet;
}

/// Leaves cells of which the point sees no whole facet, and those around subsegments
/// that would be buried, all but those at its own facets: what is open of these stays
/// open.
bool Cavity::leave_hidden(const WalledMesh &mesh, const Site &site) {
  start(mesh);
  flood(mesh, site, false);
  const std::size_t n_open = n_open_walls(mesh, site), most = cells_.size();
  for (std::size_t k = 0; k < most; ++k) {
    find_boundary(mesh, site);
    std::size_t n_left = 0;
    for (HalfFacet h : boundary_)
      if (contains(h.cell()) && !has_volume<3>(cell_with(mesh, h, site.x))) {
        mark_[h.cell()] = inside_mark() + 1;
        ++n_left;
      }
    if (n_left == 0)
      n_left = leave_around_buried(mesh, site);
    if (n_left == 0) {
      is_reduced_ = true;
      return n_open_walls(mesh, site) == n_open;
    }
    if (std::any_of(site.seeds.begin(), site.seeds.end(),
                    [&](Index c) { return !contains(c); }))
      return false;
    keep_connected(mesh, site);
  }
  return false;
}

std::size_t Cavity::leave_around_buried(const WalledMesh &mesh, const Site &site) {
  find_boundary_subsegments(mesh);
  std::size_t n_left = 0;
  for (Index c : cells_) {
    const Cell<3> &cell = mesh.cells[c];
    const auto &walls = mesh.walls[c];
    if (std::find(site.seeds.begin(), site.seeds.end(), c) != site.seeds.end() ||
        std::any_of(walls.begin(), walls.end(),
                    [&](Index wall) { return wall != none && is_open(site, wall); }))
      continue;
    if (std::any_of(edges_of_cell.begin(), edges_of_cell.end(), [&](const auto &edge) {
          return is_buried({cell[edge[0]], cell[edge[1]]}, mesh, site);
        })) {
      mark_[c] = inside_mark() + 1;
      ++n_left;
    }
  }
  return n_left;
}

std::size_t Cavity::n_open_walls(const WalledMesh &mesh, const Site &site) const {
  std::size_t n = 0;
  for (Index c : cells_)
    for (Index wall : mesh.walls[c])
      n += wall != none && is_open(site, wall);
  return n;
}

/// Of the cells that are marked those that are connected with the seeds.
void Cavity::keep_connected(const WalledMesh &mesh, const Site &site) {
  std::vector<Index> marked;
  std::swap(marked, cells_);
  std::vector<Index> kept;
  for (Index c : marked)
    if (contains(c))
      kept.push_back(c);
  for (Index c : kept)
    mark_[c] = inside_mark() + 1;
  std::sort(kept.begin(), kept.end());
  for (Index c : site.seeds)
    if (!contains(c))
      take(c);
  for (std::size_t k = 0; k < cells_.size(); ++k)
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(cells_[k], i), other = mesh.opposite(h);
      const Index wall = mesh.wall(h);
      if (other.exists() && !contains(other.cell()) &&
          (wall == none || is_open(site, wall)) &&
          std::binary_search(kept.begin(), kept.end(), other.cell()))
        take(other.cell());
    }
}

void Cavity::start(const WalledMesh &mesh) {
  ++round_;
  mark_.resize(mesh.cells.size(), 0);
  position_.resize(mesh.cells.size());
  cells_.clear();
  is_enlarged_ = is_reduced_ = false;
}

void Cavity::take(Index c) {
  mark_[c] = inside_mark();
  position_[c] = static_cast<Index>(cells_.size());
  cells_.push_back(c);
}

void Cavity::flood(const WalledMesh &mesh, const Site &site, bool only_visible) {
  const std::uint32_t outside_mark = inside_mark() + 1;
  for (Index c : site.seeds)
    if (!contains(c))
      take(c);
  for (std::size_t k = 0; k < cells_.size(); ++k)
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(cells_[k], i), other = mesh.opposite(h);
      const Index wall = mesh.wall(h), n = other.cell();
      if (!other.exists() || contains(n) || (wall != none && !is_open(site, wall)))
        continue;
      if (wall == none && only_visible && !is_seen(mesh, h, site.x))
        continue;
      if (wall == none && mark_[n] == outside_mark)
        continue;
      const bool in_conflict = mark_[n] != outside_mark &&
                               in_sphere(mesh.simplex(n), site.x) == Side::inside;
      // Beyond a wall of its own facet the sphere of a cell holds the point exactly if
      // that on this side does, but for round-off, which must not tear the two apart.
      if (wall != none && !in_conflict)
        is_enlarged_ = true;
      if (in_conflict || wall != none)
        take(n);
      else
        mark_[n] = outside_mark;
    }
}

void Cavity::find_boundary(const WalledMesh &mesh, const Site &site) {
  boundary_.clear();
  boundary_index_.resize(cells_.size());
  for (std::size_t k = 0; k < cells_.size(); ++k)
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(cells_[k], i), other = mesh.opposite(h);
      const Index wall = mesh.wall(h);
      const bool stays = wall != none ? !is_open(site, wall) : !contains(other.cell());
      boundary_index_[k][i] = stays ? static_cast<Index>(boundary_.size()) : none;
      if (stays)
        boundary_.push_back(h);
    }
}

bool Cavity::is_star_shaped(const WalledMesh &mesh, const Site &site) const {
  return std::all_of(boundary_.begin(), boundary_.end(), [&](HalfFacet h) {
    return has_volume<3>(cell_with(mesh, h, site.x));
  });
}

CavityFlaw Cavity::what_is_buried(const WalledMesh &mesh, const Site &site) {
  find_boundary_subsegments(mesh);
  on_boundary_.resize(mesh.points.size(), 0);
  for (HalfFacet h : boundary_)
    for (Index v : mesh.facet(h))
      on_boundary_[v] = round_;
  for (Index c : cells_) {
    const Cell<3> &cell = mesh.cells[c];
    for (Index v : cell)
      if (on_boundary_[v] != round_)
        return CavityFlaw::buries_vertex;
    for (const auto &[i, j] : edges_of_cell)
      if (is_buried({cell[i], cell[j]}, mesh, site))
        return CavityFlaw::buries_subsegment;
  }
  return CavityFlaw::no_flaw;
}

/// Whether an edge is a subsegment, other than the one that is split, inside.
bool Cavity::is_buried(const Segment &edge, const WalledMesh &mesh,
                       const Site &site) const {
  const Segment sorted{std::min(edge[0], edge[1]), std::max(edge[0], edge[1])};
  return mesh.segment_of(edge[0], edge[1]) != none && sorted != site.split_edge &&
         !std::binary_search(boundary_subsegments_.begin(), boundary_subsegments_.end(),
                             sorted);
}

void Cavity::find_boundary_subsegments(const WalledMesh &mesh) {
  boundary_subsegments_.clear();
  for (HalfFacet h : boundary_) {
    const Facet<3> f = mesh.facet(h);
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = f[(k + 1) % 3], b = f[(k + 2) % 3];
      if (mesh.segment_of(a, b) != none)
        boundary_subsegments_.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(boundary_subsegments_.begin(), boundary_subsegments_.end());
}

bool Cavity::find_rims(const WalledMesh &mesh) {
  rims_.assign(boundary_.size(), Rim());
  for (std::size_t b = 0; b < boundary_.size(); ++b) {
    const Facet<3> f = mesh.facet(boundary_[b]);
    for (std::size_t k = 0; k < 3; ++k) {
      // turn around the edge, inside of the cavity, to the next facet of its boundary
      Index c = boundary_[b].cell(), away = mesh.apex(boundary_[b]), ahead = f[k];
      bool ends = false;
      for (std::size_t turn = 0; turn <= cells_.size() && !ends; ++turn) {
        const std::size_t j = mesh.local_index(c, ahead);
        const Index reached = boundary_index_[position_[c]][j];
        if (reached != none) {
          rims_[b].partner[k] = reached;
          ends = true;
          continue;
        }
        const HalfFacet through(c, j), beyond = mesh.opposite(through);
        if (const Index wall = mesh.wall(through); wall != none) {
          if (rims_[b].facet[k] != none)
            return false;
          rims_[b].facet[k] = wall;
        }
        if (!beyond.exists()) {
          ends = true;
          continue;
        }
        ahead = away;
        away = mesh.apex(beyond);
        c = beyond.cell();
      }
      if (!ends)
        return false;
    }
  }
  return true;
}

Index Cavity::fill(WalledMesh &mesh, const Site &site) {
  const Index v = mesh.add_vertex(site.x, site.carrier, nearest_vertex(mesh, site.x));
  if (site.split_edge[0] != none)
    mesh.split_subsegment(site.split_edge, v);
  new_cells_.clear();
  outer_.clear();
  for (HalfFacet h : boundary_) {
    const Facet<3> f = mesh.facet(h);
    const Index c = mesh.add_cell({f[0], f[1], f[2], v}, mesh.region[h.cell()]);
    new_cells_.push_back(c);
    outer_.push_back(mesh.opposite(h));
    mesh.walls[c][3] = mesh.wall(h);
  }
  for (std::size_t b = 0; b < boundary_.size(); ++b) {
    const Index c = new_cells_[b];
    mesh.join(HalfFacet(c, 3), outer_[b]);
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.walls[c][k] = rims_[b].facet[k];
      const Index partner = rims_[b].partner[k];
      if (partner == none)
        continue;
      const auto at_edge = [&](std::size_t side) {
        return rims_[partner].partner[side] == static_cast<Index>(b) &&
               mesh.cells[new_cells_[partner]][side] != mesh.cells[c][(k + 1) % 3] &&
               mesh.cells[new_cells_[partner]][side] != mesh.cells[c][(k + 2) % 3];
      };
      for (std::size_t side = 0; side < 3; ++side)
        if (at_edge(side))
          mesh.neighbours[c][k] = HalfFacet(new_cells_[partner], side);
    }
  }
  mesh.renew_stars(cells_, new_cells_);
  for (Index c : cells_)
    mesh.free_cell(c);
  return v;
}

double Cavity::nearest_vertex(const WalledMesh &mesh, const Vector<3> &x) const {
  double least = std::numeric_limits<double>::infinity();
  for (Index c : cells_)
    for (Index v : mesh.cells[c])
      least = std::min(least, (mesh.points[v] - x).squaredNorm());
  return std::sqrt(least);
}

void Cavity::subsegments(const WalledMesh &mesh, std::vector<Segment> &out) const {
  out.clear();
  for (Index c : cells_) {
    const Cell<3> &cell = mesh.cells[c];
    for (const auto &[i, j] : edges_of_cell) {
      const Index a = cell[i], b = cell[j];
      if (mesh.segment_of(a, b) != none)
        out.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

} // namespace anistar::generate
