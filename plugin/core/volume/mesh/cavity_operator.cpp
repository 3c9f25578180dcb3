#include "volume/mesh/cavity_operator.h"

namespace anistar {
namespace {

/// Bits of a table entry that hold the port; the others are the epoch.
constexpr std::uint32_t port_bits = 13;

} // namespace

bool CavityOperator::replace(std::span<const Index> cells, Index apex,
                             std::array<Index, 2> lost, const Acceptance &acceptance) {
  const bool is_valid = propose(cells, apex, lost, acceptance);
  if (is_valid)
    commit(cells);
  return is_valid;
}

bool CavityOperator::propose(std::span<const Index> cells, Index apex,
                             std::array<Index, 2> lost, const Acceptance &acceptance) {
  apex_ = apex;
  lost_ = lost;
  is_apex_in_place_ = acceptance.is_apex_in_place;
  if (!collect(cells, acceptance) || !keeps_vertices(cells))
    return false;
  if (acceptance.longest > 0 && !keeps_lengths(acceptance.longest))
    return false;
  if (has_walls_ && (!add_rim(acceptance.hausdorff_number) || !keeps_shape(cells)))
    return false;
  if (!match() || (has_walls_ && (!constrain() || !separates_regions())))
    return false;
  if ((!surface_.empty() || volume_.fans_of(apex_)) &&
      !(keeps_link() && keeps_surface_links(cells)))
    return false;
  if (!volume_.fans.empty() && !keeps_bodies_apart(cells))
    return false;
  if (volume_.slab && !stays_in_slab(cells)) {
    volume_.is_put_off = true;
    return false;
  }
  return true;
}

bool CavityOperator::is_lost(Index u, Index w) const {
  return lost_[1] == none
             ? lost_[0] != none && (u == lost_[0] || w == lost_[0])
             : (u == lost_[0] && w == lost_[1]) || (u == lost_[1] && w == lost_[0]);
}

bool CavityOperator::is_lost(const std::array<Index, 3> &facet) const {
  if (lost_[0] == none)
    return false;
  const auto contains = [&](Index v) {
    return facet[0] == v || facet[1] == v || facet[2] == v;
  };
  return contains(lost_[0]) && (lost_[1] == none || contains(lost_[1]));
}

bool CavityOperator::collect(std::span<const Index> cells,
                             const Acceptance &acceptance) {
  Triangulation<3> &mesh = volume_.mesh;
  volume_.open_cells();
  double old_minimum = 1;
  has_walls_ = false;
  for (Index c : cells) {
    volume_.mark_cell(c);
    old_minimum = std::min(old_minimum, volume_.quality_of(c));
    has_walls_ = has_walls_ || volume_.is_walled(c);
  }
  outers_.clear();
  surface_.clear();
  const double threshold =
      acceptance.threshold(old_minimum, volume_.state.kept_quality);
  bool has_base = false;
  for (Index c : cells) {
    const bool is_walled = volume_.is_walled(c);
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(c, i), beyond = mesh.opposite(h);
      if (beyond.exists() && volume_.is_marked_cell(beyond.cell())) {
        if (is_walled && c < beyond.cell() && mesh.constraint(h) != none)
          add_surface(h, false);
      } else if (is_walled && !beyond.exists() && is_lost(mesh.facet(h))) {
        add_surface(h, true);
      } else if (!add_outer(h, threshold)) {
        return false;
      } else {
        has_base = has_base || outers_.back().kind == Kind::base;
      }
    }
  }
  return has_base && outers_.size() <= max_outer;
}

bool CavityOperator::add_outer(HalfFacet h, double threshold) {
  const Triangulation<3> &mesh = volume_.mesh;
  Outer outer{mesh.facet(h),
              mesh.opposite(h),
              mesh.constraint(h),
              mesh.region[h.cell()],
              0,
              Kind::base,
              3,
              none};
  for (std::uint8_t k = 0; k < 3; ++k)
    if (outer.v[k] == apex_) {
      outer.kind = Kind::at_apex;
      outer.apex_at = k;
    }
  if (outer.kind == Kind::base) {
    const double q =
        is_apex_in_place_ && mesh.apex(h) == apex_ // the cell stays as it is
            ? volume_.quality_of(h.cell())
            : shape_quality(mesh.vertex(outer.v[0]), mesh.vertex(outer.v[1]),
                            mesh.vertex(outer.v[2]), mesh.vertex(apex_));
    if (q < threshold || q <= 0)
      return false;
    outer.quality = static_cast<float>(q);
  }
  outers_.push_back(outer);
  return true;
}

bool CavityOperator::keeps_vertices(std::span<const Index> cells) {
  volume_.open_vertices();
  for (const Outer &outer : outers_)
    for (Index v : outer.v)
      volume_.mark_vertex(v);
  volume_.mark_vertex(apex_);
  if (lost_[1] == none && lost_[0] != none)
    volume_.mark_vertex(lost_[0]);
  for (Index c : cells)
    for (Index v : volume_.mesh.at(c))
      if (!volume_.is_marked_vertex(v))
        return false;
  return true;
}

bool CavityOperator::keeps_lengths(double longest) {
  const Vertex<3> &apex = volume_.mesh.vertex(apex_);
  volume_.open_vertices();
  volume_.mark_vertex(apex_);
  for (const Outer &outer : outers_)
    for (Index v : outer.v)
      if (volume_.mark_vertex(v) && fast_length(volume_.mesh.vertex(v), apex) > longest)
        return false;
  return true;
}

Index CavityOperator::local_index(Index v) {
  if (std::cmp_greater_equal(v, local_of_.size()))
    local_of_.resize(volume_.mesh.vertices.size() + 1024, 0);
  if (volume_.mark_vertex(v)) {
    local_of_[v] = static_cast<Index>(local_.size());
    local_.push_back(v);
  }
  return local_of_[v];
}

/// Finds the two sides of every facet at the apex: the boundary of the cavity is a
/// closed surface, every edge of which is run through once in each direction.
bool CavityOperator::match() {
  if (++epoch_ == (1u << (32 - port_bits))) {
    std::fill(table_.begin(), table_.end(), 0);
    epoch_ = 1;
  }
  volume_.open_vertices();
  local_.clear();
  pairs_.clear();
  std::size_t expected = 0;
  for (std::size_t k = 0; k < outers_.size(); ++k) {
    const Outer &outer = outers_[k];
    const auto index = static_cast<Index>(k);
    if (outer.kind == Kind::base) {
      for (std::size_t slot = 0; slot < 3; ++slot)
        if (!match_port(index, slot))
          return false;
      expected += 3;
    } else {
      if (!match_port(index, outer.apex_at))
        return false;
      ++expected;
    }
  }
  return 2 * pairs_.size() == expected;
}

bool CavityOperator::match_port(Index index, std::size_t slot) {
  const Outer &outer = outers_[index];
  const Index u = local_index(outer.v[(slot + 1) % 3]),
              w = local_index(outer.v[(slot + 2) % 3]);
  if (u >= max_local || w >= max_local)
    return false;
  std::uint32_t &mine = table_[u * max_local + w];
  if (mine >> port_bits == epoch_)
    return false; // the boundary of the cavity is pinched
  mine = epoch_ << port_bits | static_cast<std::uint32_t>(index) << 2 |
         static_cast<std::uint32_t>(slot);
  const std::uint32_t theirs = table_[w * max_local + u];
  if (theirs >> port_bits == epoch_) {
    const std::uint32_t port = theirs & ((1u << port_bits) - 1);
    pairs_.push_back({{index, slot}, {static_cast<Index>(port >> 2), port & 3}, none});
  }
  return true;
}

/// Gives the facets at the apex their patches, once each.
bool CavityOperator::constrain() {
  const auto outer_of = [&](const Port &port) -> const Outer & {
    return outers_[port.outer];
  };
  for (Pair &pair : pairs_) {
    bool has_half = false;
    for (const Port &port : {pair.one, pair.other}) {
      const Outer &outer = outer_of(port);
      has_half = has_half || outer.kind == Kind::base || outer.beyond.exists();
      if (outer.kind == Kind::base || outer.constraint == none)
        continue;
      if (pair.constraint != none)
        return false;
      pair.constraint = outer.constraint;
    }
    if (!has_half)
      return false;
  }
  for (const SurfaceEdge &edge : surface_) {
    if (edge.is_boundary)
      continue; // its rim has been matched
    bool found = false;
    for (Pair &pair : pairs_) {
      const Outer &outer = outer_of(pair.one);
      const Index u = outer.v[(pair.one.slot + 1) % 3],
                  w = outer.v[(pair.one.slot + 2) % 3];
      if ((u != edge.ends[0] || w != edge.ends[1]) &&
          (w != edge.ends[0] || u != edge.ends[1]))
        continue;
      if (found || pair.constraint != none)
        return false;
      pair.constraint = edge.patch;
      found = true;
    }
    if (!found)
      return false;
  }
  return true;
}

Index CavityOperator::region_at(const Port &port) const {
  const Outer &outer = outers_[port.outer];
  if (outer.kind == Kind::base)
    return outer.region;
  return outer.beyond.exists() ? volume_.mesh.region[outer.beyond.cell()] : none;
}

bool CavityOperator::separates_regions() const {
  for (const Pair &pair : pairs_) {
    if (pair.constraint != none)
      continue;
    if (region_at(pair.one) != region_at(pair.other))
      return false;
  }
  return true;
}

HalfFacet CavityOperator::half_of(const Port &port) const {
  const Outer &outer = outers_[port.outer];
  // a new cell has the vertices of its base, in order, and then the apex
  return outer.kind == Kind::base ? HalfFacet(outer.cell, port.slot) : outer.beyond;
}

void CavityOperator::commit(std::span<const Index> cells) {
  Triangulation<3> &mesh = volume_.mesh;
  std::size_t used = 0;
  for (Outer &outer : outers_) {
    if (outer.kind != Kind::base)
      continue;
    // the new cells take the places of the old ones first
    outer.cell = used < cells.size() ? cells[used] : volume_.add_cell();
    ++used;
    const Index c = outer.cell;
    mesh.cells[c] = {outer.v[0], outer.v[1], outer.v[2], apex_};
    mesh.neighbours[c] = {};
    mesh.constraints[c] = {none, none, none, outer.constraint};
    mesh.region[c] = outer.region;
    mesh.join(HalfFacet(outer.cell, 3), outer.beyond);
    volume_.quality[c] = outer.quality;
    volume_.walled[c] = outer.constraint != none;
    volume_.touch(outer.cell);
    for (Index v : volume_.mesh.at(outer.cell))
      volume_.at_rest[v] = 0;
    volume_.state.slabs.add_cell(mesh.cells[c]);
    for (Index v : mesh.cells[c])
      mesh.vertex_cell[v] = outer.cell;
  }
  for (std::size_t k = used; k < cells.size(); ++k)
    volume_.free_cell(cells[k]);
  join_pairs();
  if (!volume_.fans.empty())
    update_fans(cells);
}

/// The cells across the boundary of the cavity will have new neighbours.
bool CavityOperator::stays_in_slab(std::span<const Index> cells) const {
  std::size_t n_new = 0;
  for (const Outer &outer : outers_) {
    n_new += outer.kind == Kind::base;
    if (outer.beyond.exists() && !volume_.is_inside(volume_.mesh.apex(outer.beyond)))
      return false;
  }
  return n_new <= cells.size() + volume_.free_cells.size();
}

void CavityOperator::update_fans(std::span<const Index> cells) {
  const auto is_old = [&](Index c) {
    return std::find(cells.begin(), cells.end(), c) != cells.end();
  };
  const auto update = [&](Index v) {
    std::vector<Index> *fans = volume_.fans_of(v);
    if (!fans)
      return;
    std::erase_if(*fans, is_old);
    for (const Outer &outer : outers_)
      if (outer.kind == Kind::base &&
          (v == apex_ || std::find(outer.v.begin(), outer.v.end(), v) != outer.v.end()))
        fans->push_back(outer.cell);
  };
  update(apex_);
  for (Index v : local_)
    update(v);
}

void CavityOperator::join_pairs() {
  Triangulation<3> &mesh = volume_.mesh;
  for (const Pair &pair : pairs_) {
    const HalfFacet one = half_of(pair.one), other = half_of(pair.other);
    for (const auto &[half, opposite] :
         {std::pair{one, other}, std::pair{other, one}}) {
      if (!half.exists())
        continue;
      const Index c = half.cell();
      mesh.neighbours[c][half.facet()] = opposite;
      mesh.constraints[c][half.facet()] = pair.constraint;
      if (pair.constraint != none)
        volume_.walled[c] = 1;
      for (Index v : mesh.cells[c])
        mesh.vertex_cell[v] = half.cell();
    }
  }
}

} // namespace anistar
