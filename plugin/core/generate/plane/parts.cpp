#include "generate/plane/parts.h"

#include "base/errors.h"
#include "generate/plane/walk.h"
#include "mesh/disjoint_sets.h"

#include <optional>
#include <string>

namespace anistar::generate {
namespace {

constexpr Index outside = 0; ///< the part that is not bounded

/// The part of every triangle.
struct Parts {
  PerCell<Index> part;
  Index count;
};

/// The part on the other side of an edge.
Index part_beyond(const PlaneMesh &hull, const Parts &parts, HalfFacet h) {
  const HalfFacet other = hull.opposite(h);
  return other.exists() ? parts.part[other.cell()] : outside;
}

void flood(const PlaneMesh &hull, Parts &parts, std::vector<Index> &front) {
  while (!front.empty()) {
    const Index c = front.back();
    front.pop_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfFacet h(c, i), other = hull.opposite(h);
      if (hull.wall(h) != none || !other.exists() || parts.part[other.cell()] != none)
        continue;
      parts.part[other.cell()] = parts.part[c];
      front.push_back(other.cell());
    }
  }
}

Parts parts_of(const PlaneMesh &hull, Monitor &monitor) {
  Parts parts{PerCell<Index>(hull.cells.size(), none), 1};
  const auto n = static_cast<Index>(hull.cells.size());
  std::vector<Index> front;
  for (Index c = 0; c < n; ++c)
    for (std::size_t i = 0; i < 3; ++i)
      if (const HalfFacet h(c, i);
          !hull.opposite(h).exists() && hull.wall(h) == none && parts.part[c] == none) {
        parts.part[c] = outside;
        front.push_back(c);
      }
  flood(hull, parts, front);
  for (Index c = 0; c < n; ++c) {
    monitor.insist(0);
    if (parts.part[c] != none)
      continue;
    parts.part[c] = parts.count++;
    front.push_back(c);
    flood(hull, parts, front);
  }
  return parts;
}

/// A wall between two parts, from the side of the part that was reached first.
struct Border {
  HalfFacet wall;
  Index near, far;
};

/// Visits all parts from the outside on: each wall to a part that is not reached yet,
/// and then all walls between two parts.
class Search {
public:
  Search(const PlaneMesh &hull, const Parts &parts) : parts_(parts) {
    borders_.resize(parts.count);
    for (Index c = 0; c < static_cast<Index>(hull.cells.size()); ++c)
      for (std::size_t i = 0; i < 3; ++i) {
        const HalfFacet h(c, i);
        if (hull.wall(h) == none)
          continue;
        const Index here = parts.part[c], there = part_beyond(hull, parts, h);
        if (here != there)
          borders_[here].push_back({h, here, there});
        if (there == outside && !hull.opposite(h).exists() && here != outside)
          borders_[outside].push_back({h, outside, here});
      }
  }
  /// All borders of a part, seen from it; of those to the outside of the hull the wall
  /// is that of the inner side.
  [[nodiscard]] const std::vector<Border> &borders(Index part) const {
    return borders_[part];
  }
  /// Calls with the border through which each part but the outside is reached first.
  template <class Visit> void run(const Visit &visit) const {
    std::vector<bool> is_reached(parts_.count, false);
    std::vector<Index> queue{outside};
    is_reached[outside] = true;
    for (std::size_t k = 0; k < queue.size(); ++k)
      for (const Border &border : borders_[queue[k]])
        if (!is_reached[border.far]) {
          is_reached[border.far] = true;
          visit(border);
          queue.push_back(border.far);
        }
  }

private:
  const Parts &parts_;
  std::vector<std::vector<Border>> borders_;
};

/// How often the segment at a wall winds around what is on its left, seen from there:
/// plus one for a segment given once, along the wall.
Index turns_at(const PlaneMesh &hull, const PlanarComplex &complex, HalfFacet h) {
  const Index s = hull.wall(h);
  return hull.edge(h)[0] == complex.segments[s][0] ? complex.turns[s]
                                                   : -complex.turns[s];
}

/// The winding number of every part.
std::vector<Index> winding_numbers(const PlaneMesh &hull, const PlanarComplex &complex,
                                   const Parts &parts, const Search &search) {
  std::vector<Index> number(parts.count, 0);
  // a wall has the triangle it is taken from on its left
  const auto gain = [&](const Border &border) {
    const Index turns = turns_at(hull, complex, border.wall);
    return parts.part[border.wall.cell()] == border.far ? turns : -turns;
  };
  search.run([&](const Border &border) {
    number[border.far] = number[border.near] + gain(border);
  });
  for (Index part = 0; part < parts.count; ++part)
    for (const Border &border : search.borders(part))
      if (number[border.far] != number[border.near] + gain(border)) {
        const Index v = hull.edge(border.wall)[0];
        throw MeshingError("segment " + std::to_string(hull.wall(border.wall)) +
                               " is turned otherwise than the loop it is part of",
                           hull.points[v]);
      }
  return number;
}

/// Which parts an odd number of closed loops enclose. Walls that hang together are
/// loops if an even number of them meets in every point; else they divide one domain,
/// and all that they enclose counts as enclosed once.
std::vector<bool> are_enclosed(const PlaneMesh &hull, const Parts &parts,
                               const Search &search) {
  DisjointSets webs(hull.points.size());
  std::vector<Index> degree(hull.points.size(), 0);
  for (Index part = 0; part < parts.count; ++part)
    for (const Border &border : search.borders(part))
      if (border.near < border.far) {
        const auto [a, b] = hull.edge(border.wall);
        webs.join(a, b);
        ++degree[a];
        ++degree[b];
      }
  std::vector<bool> is_loops(hull.points.size(), true);
  for (std::size_t v = 0; v < degree.size(); ++v)
    if (degree[v] % 2 != 0)
      is_loops[webs.root(v)] = false;
  std::vector<Index> around(hull.points.size(), none); ///< the part around each web
  std::vector<bool> enclosed(parts.count, false);
  const auto note_around = [&](Index part) {
    for (const Border &border : search.borders(part)) {
      Index &first = around[webs.root(hull.edge(border.wall)[0])];
      first = first == none ? part : first;
    }
  };
  note_around(outside);
  search.run([&](const Border &border) {
    const std::size_t web = webs.root(hull.edge(border.wall)[0]);
    const bool changes = is_loops[web] || border.near == around[web];
    enclosed[border.far] = enclosed[border.near] != changes;
    note_around(border.far);
  });
  return enclosed;
}

/// What a part is: a region, or nothing.
using Meaning = std::optional<Index>;

std::vector<Meaning> without_seeds(const PlaneMesh &hull, const PlanarComplex &complex,
                                   const Parts &parts) {
  const Search search(hull, parts);
  std::vector<Meaning> meaning(parts.count);
  if (complex.inside == Inside::parity) {
    const std::vector<bool> enclosed = are_enclosed(hull, parts, search);
    for (Index part = 0; part < parts.count; ++part)
      if (enclosed[part])
        meaning[part] = 0;
    return meaning;
  }
  const std::vector<Index> number = winding_numbers(hull, complex, parts, search);
  for (Index part = 0; part < parts.count; ++part)
    if (complex.inside == Inside::winding ? number[part] > 0 : number[part] != 0)
      meaning[part] = complex.inside == Inside::winding ? number[part] : 0;
  return meaning;
}

/// The part around a seed or a hole.
Index part_around(const PlaneMesh &hull, const Parts &parts, const Vector<2> &x,
                  const std::string &name) {
  const Place place = walk_to(hull, 0, x, Walls::let_pass);
  const bool is_on_wall =
      place.kind == Place::Kind::on_vertex ||
      (place.kind == Place::Kind::on_edge && hull.wall(place.at) != none);
  if (is_on_wall)
    throw MeshingError(name + " is on a segment or a point", x);
  const Index part =
      place.kind == Place::Kind::beyond ? outside : parts.part[place.at.cell()];
  if (part == outside)
    throw MeshingError(name + " is in no closed loop of segments", x);
  return part;
}

/// What seeds and holes say, and which of them said it.
void follow_seeds(const PlaneMesh &hull, const PlanarComplex &complex,
                  const Parts &parts, std::vector<Meaning> &meaning) {
  std::vector<std::string> said_by(parts.count);
  const auto say = [&](const Vector<2> &x, const std::string &name, Meaning value) {
    const Index part = part_around(hull, parts, x, name);
    if (!said_by[part].empty() && meaning[part] != value)
      throw MeshingError(said_by[part] + " and " + name + " are in one part", x);
    said_by[part] = name;
    meaning[part] = value;
  };
  for (std::size_t k = 0; k < complex.seeds.size(); ++k)
    say(complex.seeds[k], "the seed of region " + std::to_string(complex.seed_tags[k]),
        complex.seed_tags[k]);
  for (std::size_t k = 0; k < complex.holes.size(); ++k)
    say(complex.holes[k], "hole " + std::to_string(k), Meaning{});
}

PlaneMesh kept(const PlaneMesh &hull, const Parts &parts,
               const std::vector<Meaning> &meaning) {
  PerCell<Index> number(hull.cells.size(), none);
  Index count = 0;
  for (std::size_t c = 0; c < hull.cells.size(); ++c)
    if (meaning[parts.part[c]])
      number[c] = count++;
  PlaneMesh mesh;
  mesh.points = hull.points;
  for (std::size_t c = 0; c < hull.cells.size(); ++c) {
    if (number[c] == none)
      continue;
    Neighbours<2> around;
    for (std::size_t i = 0; i < 3; ++i)
      if (const HalfFacet other = hull.neighbours[c][i];
          other.exists() && number[other.cell()] != none)
        around[i] = HalfFacet(number[other.cell()], other.facet());
    mesh.cells.push_back(hull.cells[c]);
    mesh.neighbours.push_back(around);
    mesh.walls.push_back(hull.walls[c]);
    mesh.regions.push_back(*meaning[parts.part[c]]);
  }
  return mesh;
}

} // namespace

PlaneMesh inside_of(const PlaneMesh &hull, const PlanarComplex &complex,
                    Monitor &monitor) {
  const Parts parts = parts_of(hull, monitor);
  std::vector<Meaning> meaning = without_seeds(hull, complex, parts);
  follow_seeds(hull, complex, parts, meaning);
  PlaneMesh mesh = kept(hull, parts, meaning);
  if (mesh.cells.empty())
    throw MeshingError("the segments enclose nothing", hull.points.front());
  return mesh;
}

} // namespace anistar::generate
