#include "generate/constrained/flat/flat_cells.h"

#include "base/errors.h"
#include "generate/constrained/points/cell_shape.h"
#include "generate/constrained/regions/regions.h"

#include <algorithm>
#include <optional>

namespace anistar::generate {
namespace {

/// Shapes below this are no volumes to compute with.
constexpr double flat = 1e-9;
/// What is on two triangles of a nearly planar facet is flatter than that.
constexpr double flat_on_facet = 1e-2;
/// A swap that makes no cell flatter than that may be made for the sake of another.
constexpr double harmless = 1e-4;
constexpr int most_passes = 4;
constexpr int most_failures = 1000; ///< of points in the volume

} // namespace

FlatCells::FlatCells(ExactPoints &points, GhostMesh &mesh, const FacetTriangles &facets,
                     PerCell<Index> &regions)
    : points_(points), mesh_(mesh), facets_(facets), regions_(regions),
      facet_of_plane_(facets.facets_of_planes()), swaps_(points, mesh, regions),
      moves_(points, mesh, regions), volume_points_(points, mesh, facets, regions) {}

bool FlatCells::is_inside(Index c) const {
  return mesh_.is_alive(c) && regions_[c] != outside;
}

FlatCells::Counts FlatCells::remove(bool may_peel, Monitor &monitor) {
  if (may_peel)
    for (bool is_new = true; is_new;) {
      is_new = false;
      for (const Index c : flat_cells(flat_on_facet))
        is_new |= peel_outwards(c);
      monitor.insist(points_.size());
    }
  for (int pass = 0; pass < most_passes; ++pass) {
    monitor.insist(points_.size());
    bool is_new = false;
    for (const Index c : flat_cells(flat))
      if (is_inside(c) && shape_of(points_, mesh_.cell(c)) < flat)
        is_new |= swap(c) || (may_peel && peel_and_swap(c)) || swap_after_another(c) ||
                  move(c);
    if (!is_new)
      break;
  }
  insert_points(monitor); // after the moves, which would have to move these along
  for (const Index c : flat_cells(flat)) {
    ++counts_.left;
    counts_.on_flat_walls += has_flat_wall(c);
  }
  return counts_;
}

std::vector<Index> FlatCells::flat_cells(double bound) const {
  std::vector<Index> found;
  for (Index c = 0; c < mesh_.n_slots(); ++c)
    if (is_inside(c) && shape_of(points_, mesh_.cell(c)) < bound)
      found.push_back(c);
  return found;
}

bool FlatCells::is_on_wall(Index a, Index b) const {
  const auto place = mesh_.find_edge(a, b);
  if (!place)
    return false;
  std::vector<HalfFacet> ring;
  mesh_.ring(*place, ring);
  return std::ranges::any_of(ring, [&](HalfFacet leave) { // each facet at the edge once
    return mesh_.wall(leave) != none;
  });
}

std::optional<FlatCells::Peel> FlatCells::peel_of(Index c) const {
  std::vector<std::size_t> walls, others;
  for (std::size_t i = 0; i < 4; ++i)
    (mesh_.wall({c, i}) != none ? walls : others).push_back(i);
  if (walls.size() != 2)
    return std::nullopt;
  const Peel peel{c, walls[0], walls[1], others[0], others[1]};
  const HalfFacet one(c, peel.i), other(c, peel.j);
  const Cell<3> &cell = mesh_.cell(c);
  if (facet_of_plane_[mesh_.wall(one)] != facet_of_plane_[mesh_.wall(other)] ||
      regions_[mesh_.opposite(one).cell()] != regions_[mesh_.opposite(other).cell()] ||
      facets_.is_segment(cell[peel.k], cell[peel.l]) ||
      facets_.is_segment(cell[peel.i], cell[peel.j]) ||
      is_on_wall(cell[peel.i], cell[peel.j]))
    return std::nullopt;
  return peel;
}

/// The other two facets of the cell become the walls.
void FlatCells::pass_walls(const Peel &peel) {
  const Index one = mesh_.wall({peel.cell, peel.i}),
              other = mesh_.wall({peel.cell, peel.j});
  const Index beyond = regions_[mesh_.opposite({peel.cell, peel.i}).cell()];
  mesh_.set_wall({peel.cell, peel.i}, none);
  mesh_.set_wall({peel.cell, peel.j}, none);
  mesh_.set_wall({peel.cell, peel.k}, one);
  mesh_.set_wall({peel.cell, peel.l}, other);
  regions_[peel.cell] = beyond;
}

bool FlatCells::peel_outwards(Index c) {
  const auto peel = peel_of(c);
  if (!peel || regions_[mesh_.opposite({c, peel->i}).cell()] != outside)
    return false;
  pass_walls(*peel);
  ++counts_.peeled;
  return true;
}

/// Passes a cell to the other side of a facet if it can be swapped away there.
bool FlatCells::peel_and_swap(Index c) {
  const auto peel = peel_of(c);
  if (!peel)
    return false;
  const Index region = regions_[c];
  pass_walls(*peel);
  const Cell<3> cell = mesh_.cell(c);
  const auto better = swaps_.without_edge(cell[peel->k], cell[peel->l]);
  if (better && is_worth(*better)) {
    make(*better);
    ++counts_.peeled;
    ++counts_.swapped;
    return true;
  }
  pass_walls({c, peel->k, peel->l, peel->i, peel->j});
  regions_[c] = region;
  return false;
}

std::vector<Swap> FlatCells::swaps_at(Index c) {
  const Cell<3> cell = mesh_.cell(c);
  std::vector<Swap> found;
  const auto note = [&](std::optional<Swap> candidate) {
    if (candidate)
      found.push_back(std::move(*candidate));
  };
  for (std::size_t i = 0; i < 4; ++i) {
    note(swaps_.without_facet({c, i}));
    for (std::size_t j = i + 1; j < 4; ++j)
      if (!facets_.is_segment(cell[i], cell[j]))
        note(swaps_.without_edge(cell[i], cell[j]));
  }
  return found;
}

bool FlatCells::swap(Index c) {
  std::optional<Swap> best;
  for (Swap &candidate : swaps_at(c))
    if (is_worth(candidate) && (!best || candidate.least_after > best->least_after))
      best = std::move(candidate);
  if (!best)
    return false;
  make(*best);
  ++counts_.swapped;
  return true;
}

bool FlatCells::move(Index c) {
  const bool is_better = moves_.improve(c);
  counts_.moved += is_better;
  return is_better;
}

/// Gives up after many cells that no point helps, as each takes a thousand trials.
void FlatCells::insert_points(Monitor &monitor) {
  int failures = 0;
  for (const Index c : flat_cells(flat)) {
    monitor.insist(points_.size());
    if (is_inside(c) && shape_of(points_, mesh_.cell(c)) < flat && !has_flat_wall(c) &&
        !insert_point(c) && ++failures == most_failures)
      return;
  }
}

/// Makes a star of cells at a new point, which takes the place of cells about a flat
/// one.
bool FlatCells::insert_point(Index c) {
  const auto star = volume_points_.star_in_place_of(c);
  if (!star)
    return false;
  make(*star);
  ++counts_.inserted;
  return true;
}

/// Whether a wall of a cell has no area to speak of: then no other cells are better.
bool FlatCells::has_flat_wall(Index c) const {
  for (std::size_t i = 0; i < 4; ++i) {
    const HalfFacet h(c, i);
    const auto [u, v, w] = mesh_.facet(h);
    if (mesh_.wall(h) != none && shape_of(points_, u, v, w) < flat)
      return true;
  }
  return false;
}

/// Makes room by a harmless swap beside a cell that cannot be swapped as things are.
bool FlatCells::swap_after_another(Index c) {
  for (const auto &[a, b] : swaps_.edges_about(c)) {
    if (facets_.is_segment(a, b))
      continue;
    const auto first = swaps_.without_edge(a, b);
    if (!first || first->least_after < harmless ||
        std::ranges::find(first->old, c) != first->old.end())
      continue;
    Swap back;
    for (const Index old : first->old)
      back.cells.push_back(mesh_.cell(old));
    back.old = make(*first);
    if (swap(c))
      return true;
    make(back);
  }
  return false;
}

std::vector<Index> FlatCells::make(const Swap &swap) {
  const Index region = regions_[swap.old.front()];
  auto made = mesh_.replace(swap.old, swap.cells);
  if (!made)
    throw MeshingError("cells that were swapped do not fit",
                       points_.rounded(swap.cells.front()[0]));
  regions_.resize(mesh_.n_slots(), outside);
  for (const Index c : *made)
    regions_[c] = region;
  return std::move(*made);
}

} // namespace anistar::generate
