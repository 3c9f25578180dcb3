#include "generate/constrained/regions/regions.h"

#include "base/errors.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string>

namespace anistar::generate {
namespace {

/// A way through a wall from one component to another.
struct Passage {
  Index to;
  Index turns; ///< what it adds to the winding number
};

/// The parts into which walls divide space; the first one is outside.
class Components {
public:
  Components(const ExactPoints &points, const GhostMesh &mesh,
             const FacetTriangles &facets)
      : points_(points), mesh_(mesh), facets_(facets), of_cell_(mesh.n_slots(), none) {
    for (const bool is_ghost : {true, false})
      for (Index c = 0; c < mesh.n_slots(); ++c)
        if (mesh.is_alive(c) && of_cell_[c] == none && mesh.is_ghost(c) == is_ghost)
          flood(c);
    passages_.resize(n_);
    for (Index c = 0; c < mesh.n_slots(); ++c)
      if (mesh.is_alive(c))
        add_passages(c);
  }

  [[nodiscard]] Index size() const { return n_; }
  [[nodiscard]] Index of(Index cell) const { return of_cell_[cell]; }

  /// The number of walls from the outside, and the turns on the first way.
  struct Depth {
    Index walls = none, turns = 0;
  };
  [[nodiscard]] std::vector<Depth> depths() const {
    std::vector<Depth> depth(n_);
    std::vector<Index> reached{0};
    depth[0].walls = 0;
    for (std::size_t k = 0; k < reached.size(); ++k)
      for (const auto &[to, turns] : passages_[reached[k]])
        if (depth[to].walls == none) {
          depth[to] = {depth[reached[k]].walls + 1, depth[reached[k]].turns + turns};
          reached.push_back(to);
        }
    return depth;
  }

private:
  const ExactPoints &points_;
  const GhostMesh &mesh_;
  const FacetTriangles &facets_;
  PerCell<Index> of_cell_;
  std::vector<std::vector<Passage>> passages_;
  Index n_ = 0;

  void flood(Index seed) {
    std::vector<Index> found{seed};
    of_cell_[seed] = n_;
    while (!found.empty()) {
      const Index c = found.back();
      found.pop_back();
      for (std::size_t i = 0; i < 4; ++i) {
        const HalfFacet h(c, i);
        const Index next = mesh_.opposite(h).cell();
        if (mesh_.wall(h) == none && of_cell_[next] == none) {
          of_cell_[next] = n_;
          found.push_back(next);
        }
      }
    }
    ++n_;
  }

  void add_passages(Index c) {
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(c, i);
      const Index from = of_cell_[c], to = of_cell_[mesh_.opposite(h).cell()];
      if (from == to)
        continue;
      auto &known = passages_[from];
      if (std::ranges::none_of(known, [&](const Passage &p) { return p.to == to; }))
        known.push_back({to, is_above(h) ? 1 : -1});
    }
  }

  /// Whether the facet shows the cell its outer side.
  [[nodiscard]] bool is_above(HalfFacet h) const {
    const auto [a, b, c] = facets_.planes()[mesh_.wall(h)];
    const Index apex = mesh_.apex(h);
    if (apex != ghost)
      return points_.orientation(a, b, c, apex) == Orientation::positive;
    return !is_above(mesh_.opposite(h));
  }
};

/// The finite cell that contains a place, on whose border it may lie.
std::optional<Index> cell_around(const ExactPoints &points, const GhostMesh &mesh,
                                 const Vector<3> &place, const std::string &name) {
  for (Index c = 0; c < mesh.n_slots(); ++c) {
    if (!mesh.is_alive(c) || mesh.is_ghost(c))
      continue;
    bool is_around = true, is_on_wall = false;
    for (std::size_t i = 0; i < 4 && is_around; ++i) {
      const auto [a, b, e] = mesh.facet({c, i});
      const Orientation side = points.orientation(a, b, e, place);
      is_around = side != Orientation::negative;
      is_on_wall |= side == Orientation::degenerate && mesh.wall({c, i}) != none;
    }
    if (is_around && is_on_wall)
      throw MeshingError(name + " lies on a facet", place);
    if (is_around)
      return c;
  }
  return std::nullopt;
}

class Labels {
public:
  Labels(const ExactPoints &points, const GhostMesh &mesh, const Components &components)
      : points_(points), mesh_(mesh), components_(components),
        of_component_(components.size(), outside), seeded_by_(components.size(), none) {
  }

  void follow_rule(RegionRule rule, const std::vector<Seed> &seeds) {
    std::set<Index> taken;
    for (const Seed &seed : seeds)
      taken.insert(seed.tag);
    Index next = 1;
    const auto depths = components_.depths();
    for (Index k = 1; k < components_.size(); ++k) {
      const auto [walls, turns] = depths[k];
      if (rule == RegionRule::parity ? walls % 2 == 0 : turns == 0)
        continue;
      while (taken.contains(next))
        ++next;
      of_component_[k] = rule == RegionRule::winding ? turns : next++;
    }
  }

  void sow(const std::vector<Seed> &seeds) {
    for (std::size_t k = 0; k < seeds.size(); ++k) {
      const std::string name = "the seed of region " + std::to_string(seeds[k].tag);
      const Index component = component_around(seeds[k].at, name);
      if (component == 0)
        throw MeshingError(name + " lies outside of all facets", seeds[k].at);
      const Index other = seeded_by_[component];
      if (other != none && seeds[other].tag != seeds[k].tag)
        throw MeshingError(name + " and that of region " +
                               std::to_string(seeds[other].tag) +
                               " are not separated by facets",
                           seeds[k].at);
      seeded_by_[component] = static_cast<Index>(k);
      of_component_[component] = seeds[k].tag;
    }
  }

  void dig(const std::vector<Vector<3>> &holes) {
    for (std::size_t k = 0; k < holes.size(); ++k) {
      const std::string name = "hole " + std::to_string(k);
      const Index component = component_around(holes[k], name);
      if (seeded_by_[component] != none)
        throw MeshingError(name + " lies in a region that has a seed", holes[k]);
      of_component_[component] = outside;
    }
  }

  [[nodiscard]] const std::vector<Index> &of_component() const { return of_component_; }

private:
  const ExactPoints &points_;
  const GhostMesh &mesh_;
  const Components &components_;
  std::vector<Index> of_component_;
  std::vector<Index> seeded_by_;

  [[nodiscard]] Index component_around(const Vector<3> &place,
                                       const std::string &name) const {
    const auto c = cell_around(points_, mesh_, place, name);
    return c ? components_.of(*c) : 0;
  }
};

} // namespace

PerCell<Index> regions_of(const ExactPoints &points, const GhostMesh &mesh,
                          const FacetTriangles &facets, const RegionChoice &choice) {
  const Components components(points, mesh, facets);
  if (components.size() == 1)
    throw MeshingError("the facets enclose nothing: their surface has an open border",
                       points.rounded(0));
  Labels labels(points, mesh, components);
  labels.follow_rule(choice.rule, choice.seeds);
  labels.sow(choice.seeds);
  labels.dig(choice.holes);
  const auto &of_component = labels.of_component();
  if (std::ranges::all_of(of_component, [](Index label) { return label == outside; }))
    throw MeshingError("no region is inside", points.rounded(0));
  PerCell<Index> regions(mesh.n_slots(), outside);
  for (Index c = 0; c < mesh.n_slots(); ++c)
    if (mesh.is_alive(c))
      regions[c] = of_component[components.of(c)];
  return regions;
}

} // namespace anistar::generate
