#include "generate/refinement/mesh/flips.h"

#include "generate/refinement/mesh/spheres.h"

#include <algorithm>

namespace anistar::generate {
namespace {

/// Of one call, so that it ends whatever happens.
constexpr std::size_t most_flips = 100000;

/// Points in a plane on a circle, but for round-off, are of no sphere's inside, and
/// what is flat by that much is no cell: around holes flips would make such cells.
bool is_flat(const Simplex<3> &s) {
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      longest = std::max(longest, (s[i] - s[j]).squaredNorm());
  return volume_determinant<3>(s) <= on_sphere * longest * std::sqrt(longest);
}

} // namespace

bool is_locally_delaunay(const WalledMesh &mesh, HalfFacet h) {
  const HalfFacet other = mesh.opposite(h);
  return !other.exists() || mesh.wall(h) != none ||
         in_sphere(mesh.simplex(h.cell()), mesh.points[mesh.apex(other)]) !=
             Side::inside;
}

void Flips::restore(WalledMesh &mesh, std::span<const Index> cells) {
  new_cells_.clear();
  for (Index c : cells)
    push_facets(mesh, c);
  flip_all(mesh);
}

void Flips::retry(WalledMesh &mesh) {
  new_cells_.clear();
  std::swap(line_, stuck_);
  flip_all(mesh);
}

void Flips::push_facets(const WalledMesh &mesh, Index c) {
  for (std::size_t i = 0; i < 4; ++i)
    line_.push_back({HalfFacet(c, i), mesh.birth[c]});
}

void Flips::flip_all(WalledMesh &mesh) {
  for (std::size_t n_flips = 0; !line_.empty() && n_flips < most_flips;) {
    const Waiting next = line_.back();
    line_.pop_back();
    const Index c = next.facet.cell();
    if (!mesh.is_alive(c) || mesh.birth[c] != next.birth ||
        is_locally_delaunay(mesh, next.facet))
      continue;
    if (const std::optional<Flip> flip = flip_of(mesh, next.facet)) {
      apply(mesh, next.facet, *flip);
      ++n_flips;
    } else {
      stuck_.push_back(next);
    }
  }
  line_.clear();
  std::sort(new_cells_.begin(), new_cells_.end());
  new_cells_.erase(std::unique(new_cells_.begin(), new_cells_.end()), new_cells_.end());
}

std::optional<Flips::Flip> Flips::flip_of(const WalledMesh &mesh, HalfFacet h) const {
  const HalfFacet other = mesh.opposite(h);
  const Facet<3> f = mesh.facet(h);
  const Index a = mesh.apex(h), b = mesh.apex(other);
  const bool is_by_rounding =
      !encroaches(mesh.points[b], circumscribed_ball(mesh.simplex(h.cell())));
  Flip flip{{h.cell(), other.cell()}, {}, 3};
  for (std::size_t k = 0; k < 3; ++k) {
    Cell<3> cell{f[0], f[1], f[2], a};
    cell[k] = b;
    const Simplex<3> s{mesh.points[cell[0]], mesh.points[cell[1]], mesh.points[cell[2]],
                       mesh.points[a]};
    const Orientation turn = orientation<3>(s);
    if (turn == Orientation::positive && is_by_rounding && is_flat(s))
      return {};
    if (turn == Orientation::positive)
      flip.born.push_back(cell);
    else if (turn == Orientation::degenerate || flip.open_corner < 3)
      return {};
    else
      flip.open_corner = k;
  }
  if (flip.open_corner == 3)
    return flip;
  // the edge of f away from the open corner goes, if one more cell is all there is
  // there
  const Index corner = f[flip.open_corner];
  const HalfFacet to_a(h.cell(), mesh.local_index(h.cell(), corner)),
      to_b(other.cell(), mesh.local_index(other.cell(), corner));
  const HalfFacet beyond_a = mesh.opposite(to_a), beyond_b = mesh.opposite(to_b);
  if (!beyond_a.exists() || !beyond_b.exists() || beyond_a.cell() != beyond_b.cell() ||
      mesh.wall(to_a) != none || mesh.wall(to_b) != none ||
      mesh.segment_of(f[(flip.open_corner + 1) % 3], f[(flip.open_corner + 2) % 3]) !=
          none)
    return {};
  flip.dead.push_back(beyond_a.cell());
  return flip;
}

void Flips::apply(WalledMesh &mesh, HalfFacet h, const Flip &flip) {
  /// A facet of the cells that go, which stays: with what is beyond.
  struct Outer {
    Facet<3> vertices; // sorted
    HalfFacet beyond;
    Index wall;
  };
  const auto sorted_facet = [&](HalfFacet side) {
    Facet<3> f = mesh.facet(side);
    std::sort(f.begin(), f.end());
    return f;
  };
  std::vector<Outer> outer;
  for (Index c : flip.dead)
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet side(c, i), beyond = mesh.opposite(side);
      const bool goes = beyond.exists() && mesh.wall(side) == none &&
                        std::find(flip.dead.begin(), flip.dead.end(), beyond.cell()) !=
                            flip.dead.end();
      if (!goes)
        outer.push_back({sorted_facet(side), beyond, mesh.wall(side)});
    }
  const Index cell_region = mesh.region[h.cell()];
  std::vector<Index> born;
  std::vector<std::pair<Facet<3>, HalfFacet>> inner;
  for (const Cell<3> &cell : flip.born) {
    const Index c = mesh.add_cell(cell, cell_region);
    born.push_back(c);
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet side(c, i);
      const Facet<3> vertices = sorted_facet(side);
      const auto found = std::find_if(outer.begin(), outer.end(), [&](const Outer &o) {
        return o.vertices == vertices;
      });
      if (found != outer.end()) {
        mesh.walls[c][i] = found->wall;
        mesh.join(side, found->beyond);
        continue;
      }
      const auto mate = std::find_if(inner.begin(), inner.end(), [&](const auto &one) {
        return one.first == vertices;
      });
      if (mate != inner.end())
        mesh.join(side, mate->second);
      else
        inner.emplace_back(vertices, side);
    }
  }
  mesh.renew_stars(flip.dead, born);
  for (Index c : flip.dead)
    mesh.free_cell(c);
  for (Index c : born) {
    push_facets(mesh, c);
    new_cells_.push_back(c);
  }
}

} // namespace anistar::generate
