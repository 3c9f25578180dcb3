#include "generate/repair/orientation.h"

#include "search/box_tree.h"

#include <algorithm>

namespace anistar::generate {
namespace {

/// An edge of a triangle, and whether the triangle runs it upwards.
struct Side {
  std::array<Index, 2> ends;
  Index triangle;
  bool is_upward;
};

struct Neighbour {
  Index triangle = none;
  bool is_opposite = false; ///< runs the shared edge in the same direction
};

/// The triangles across the edges that two triangles share.
std::vector<std::array<Neighbour, 3>>
neighbours_of(std::span<const Facet<3>> triangles) {
  std::vector<Side> sides;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      sides.push_back({{std::min(a, b), std::max(a, b)}, static_cast<Index>(t), a < b});
    }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Side &a, const Side &b) { return a.ends < b.ends; });
  std::vector<std::array<Neighbour, 3>> across(triangles.size());
  std::vector<std::size_t> n_across(triangles.size(), 0);
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i;
    while (end < sides.size() && sides[end].ends == sides[i].ends)
      ++end;
    if (end - i == 2) {
      const Side &one = sides[i], &other = sides[i + 1];
      const bool is_opposite = one.is_upward == other.is_upward;
      across[one.triangle][n_across[one.triangle]++] = {other.triangle, is_opposite};
      across[other.triangle][n_across[other.triangle]++] = {one.triangle, is_opposite};
    }
    i = end;
  }
  return across;
}

/// Six times the signed volume below a triangle.
double volume_below(std::span<const Vector<3>> points, const Facet<3> &t,
                    const Vector<3> &origin) {
  const Vector<3> a = points[t[0]] - origin, b = points[t[1]] - origin,
                  c = points[t[2]] - origin;
  return a.dot(b.cross(c));
}

/// A part of a surface without borders.
struct ClosedPart {
  std::vector<Index> triangles;
  Box<3> box;
  double volume = 0; ///< six times that
  std::size_t n_turned = 0;

  [[nodiscard]] bool encloses(const ClosedPart &other) const {
    return (box.low.array() < other.box.low.array()).all() &&
           (box.high.array() > other.box.high.array()).all();
  }
};

ClosedPart closed_part(std::span<const Vector<3>> points,
                       std::span<const Facet<3>> triangles, std::vector<Index> part,
                       const std::vector<bool> &is_turned) {
  ClosedPart out;
  const Vector<3> &origin = points[triangles[part.front()][0]];
  for (const Index t : part) {
    out.n_turned += is_turned[t] ? 1 : 0;
    out.volume += (is_turned[t] ? -1 : 1) * volume_below(points, triangles[t], origin);
    for (const Index v : triangles[t])
      out.box.extend(points[v]);
  }
  out.triangles = std::move(part);
  return out;
}

} // namespace

TurnedTriangles turned_triangles(std::span<const Vector<3>> points,
                                 std::span<const Facet<3>> triangles) {
  const auto across = neighbours_of(triangles);
  TurnedTriangles out{std::vector<bool>(triangles.size(), false), 0, 0};
  std::vector<ClosedPart> closed;
  std::vector<bool> is_seen(triangles.size(), false);
  for (std::size_t start = 0; start < triangles.size(); ++start) {
    if (is_seen[start])
      continue;
    std::vector<Index> part{static_cast<Index>(start)};
    is_seen[start] = true;
    bool is_closed = true, is_one_sided = false;
    for (std::size_t k = 0; k < part.size(); ++k)
      for (const Neighbour &next : across[part[k]]) {
        if (next.triangle == none) {
          is_closed = false;
          continue;
        }
        const bool turned = out.is_turned[part[k]] != next.is_opposite;
        if (is_seen[next.triangle]) {
          is_one_sided |= out.is_turned[next.triangle] != turned;
          continue;
        }
        is_seen[next.triangle] = true;
        out.is_turned[next.triangle] = turned;
        part.push_back(next.triangle);
      }
    out.n_open += is_closed ? 0 : 1;
    out.n_one_sided += is_one_sided ? 1 : 0;
    if (is_closed)
      closed.push_back(closed_part(points, triangles, std::move(part), out.is_turned));
  }
  for (const ClosedPart &part : closed) {
    // what is inside of something else may be a hollow: most of it keeps its sense
    const bool is_nested =
        std::any_of(closed.begin(), closed.end(), [&](const ClosedPart &other) {
          return &other != &part && other.encloses(part);
        });
    if (is_nested ? 2 * part.n_turned > part.triangles.size() : part.volume < 0)
      for (const Index t : part.triangles)
        out.is_turned[t] = !out.is_turned[t];
  }
  return out;
}

} // namespace anistar::generate
