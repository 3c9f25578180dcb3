#include "generate/constrained/facets/facet_triangles.h"

#include <algorithm>
#include <optional>

namespace anistar::generate {
namespace {

constexpr std::size_t next_place(std::size_t i) { return i == 2 ? 0 : i + 1; }

Index code_of(Index triangle, std::size_t place) {
  return 3 * triangle + static_cast<Index>(place);
}

TriangleSide side_of(Index code) {
  return {code / 3, static_cast<std::size_t>(code % 3)};
}

} // namespace

FacetTriangles::FacetTriangles(const Plc &plc) {
  const std::size_t n_expected = 3 * plc.triangles.size() / 2 + plc.segments.size();
  table_.reserve(n_expected);
  edges_.reserve(n_expected);
  for (const auto &[a, b] : plc.segments) {
    lines_.push_back({a, b, static_cast<Index>(lines_.size())});
    add_edge(a, b, static_cast<Index>(lines_.size()) - 1);
  }
  triangles_.reserve(plc.triangles.size());
  for (std::size_t k = 0; k < plc.triangles.size(); ++k) {
    triangles_.push_back({plc.triangles[k], {}, {}, plc.triangle_facets[k]});
    link(static_cast<Index>(k));
  }
}

Index FacetTriangles::add_edge(Index a, Index b, Index line) {
  const Index known = table_.find(a, b);
  if (known != none) {
    edges_[known].line = std::max(edges_[known].line, line);
    return known;
  }
  const auto edge = static_cast<Index>(edges_.size());
  edges_.push_back({a, b, none, line, true});
  table_.put(a, b, edge);
  return edge;
}

void FacetTriangles::remove_edge(Index edge) {
  edges_[edge].is_alive = false;
  table_.erase(edges_[edge].from, edges_[edge].to);
}

/// Enters a triangle at its three edges.
void FacetTriangles::link(Index triangle) {
  Triangle &t = triangles_[triangle];
  for (std::size_t i = 0; i < 3; ++i) {
    t.edges[i] = add_edge(t.vertices[i], t.vertices[next_place(i)], none);
    t.next[i] = edges_[t.edges[i]].first;
    edges_[t.edges[i]].first = code_of(triangle, i);
  }
}

void FacetTriangles::unlink(Index triangle) {
  const Triangle &t = triangles_[triangle];
  for (std::size_t i = 0; i < 3; ++i) {
    Index *at = &edges_[t.edges[i]].first;
    while (*at != code_of(triangle, i)) {
      const auto [other, place] = side_of(*at);
      at = &triangles_[other].next[place];
    }
    *at = t.next[i];
  }
}

std::vector<TriangleSide> FacetTriangles::sides(Index edge) const {
  std::vector<TriangleSide> out;
  for (Index code = edges_[edge].first; code != none;) {
    out.push_back(side_of(code));
    code = triangles_[out.back().triangle].next[out.back().place];
  }
  return out;
}

std::vector<std::vector<Index>> FacetTriangles::triangles_by_plane() const {
  std::vector<std::vector<Index>> out(planes_.size());
  for (std::size_t k = 0; k < triangles_.size(); ++k)
    if (triangles_[k].plane != none)
      out[triangles_[k].plane].push_back(static_cast<Index>(k));
  return out;
}

std::vector<Index> FacetTriangles::facets_of_planes() const {
  std::vector<Index> out(planes_.size(), none);
  for (const Triangle &t : triangles_)
    if (t.plane != none)
      out[t.plane] = t.facet;
  return out;
}

/// The triangle that continues the facet in the same sense, `none` at a segment, where
/// there are more than two, and where the other one is turned over.
Index FacetTriangles::same_facet_across(const Triangle &triangle,
                                        std::size_t place) const {
  const Edge &edge = edges_[triangle.edges[place]];
  if (edge.line != none)
    return none;
  const auto both = sides(triangle.edges[place]);
  if (both.size() != 2)
    return none;
  for (const auto &[other, at] : both) {
    const Triangle &t = triangles_[other];
    if (&t != &triangle && t.facet == triangle.facet &&
        t.vertices[at] != triangle.vertices[place])
      return other;
  }
  return none;
}

Index FacetTriangles::add_plane(Index triangle, ExactPoints &points) {
  Triangle &t = triangles_[triangle];
  t.plane = static_cast<Index>(planes_.size());
  planes_.push_back(t.vertices);
  for (const Index v : t.vertices)
    points.put_on_plane(v, t.plane);
  return t.plane;
}

void FacetTriangles::flood_plane(Index seed, ExactPoints &points) {
  const Index plane = add_plane(seed, points);
  const auto [a, b, c] = planes_[plane];
  std::vector<Index> found{seed};
  for (std::size_t k = 0; k < found.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      const Index other = same_facet_across(triangles_[found[k]], i);
      if (other == none || triangles_[other].plane != none)
        continue;
      Triangle &t = triangles_[other];
      if (points.are_collinear(t.vertices[0], t.vertices[1], t.vertices[2]) ||
          !std::ranges::all_of(t.vertices, [&, a = a, b = b, c = c](Index v) {
            return points.orientation(a, b, c, v) == Orientation::degenerate;
          }))
        continue;
      t.plane = plane;
      for (const Index v : t.vertices)
        points.put_on_plane(v, plane);
      found.push_back(other);
    }
}

void FacetTriangles::find_planes(ExactPoints &points) {
  for (Index k = 0; k < static_cast<Index>(triangles_.size()); ++k) {
    const auto [a, b, c] = triangles_[k].vertices;
    if (triangles_[k].plane == none && !points.are_collinear(a, b, c))
      flood_plane(k, points);
  }
  for (Index edge = 0; edge < static_cast<Index>(edges_.size()); ++edge) {
    if (!edges_[edge].is_alive || is_required(edge))
      continue;
    const auto both = sides(edge);
    if (both.size() != 2 || triangles_[both[0].triangle].plane == none ||
        triangles_[both[0].triangle].plane != triangles_[both[1].triangle].plane)
      require(edge);
  }
}

void FacetTriangles::require(Index edge) {
  edges_[edge].line = static_cast<Index>(lines_.size());
  lines_.push_back({edges_[edge].from, edges_[edge].to, none});
}

std::array<Index, 2> FacetTriangles::split(Index edge, Index p) {
  const auto [from, to, first, line, alive] = edges_[edge];
  const auto at_edge = sides(edge);
  for (const auto &[k, i] : at_edge)
    unlink(k);
  remove_edge(edge);
  const std::array<Index, 2> parts{add_edge(from, p, line), add_edge(p, to, line)};
  for (const auto &[k, i] : at_edge) {
    const std::size_t j = next_place(i);
    Triangle far = triangles_[k];
    far.vertices[i] = p;
    triangles_[k].vertices[j] = p;
    link(k);
    triangles_.push_back(far);
    link(static_cast<Index>(triangles_.size()) - 1);
  }
  return parts;
}

std::optional<FacetTriangles::Quad> FacetTriangles::quad(Index edge) const {
  const Edge &e = edges_[edge];
  if (!e.is_alive || (e.line != none && !lines_[e.line].is_flat()))
    return std::nullopt;
  const auto both = sides(edge);
  if (both.size() != 2)
    return std::nullopt;
  const auto &[one, i] = both[0];
  const auto &[other, j] = both[1];
  const Triangle &t = triangles_[one], &s = triangles_[other];
  if (t.facet != s.facet || t.vertices[i] == s.vertices[j])
    return std::nullopt;
  return Quad{t.vertices[i], t.vertices[next_place(i)],
              t.vertices[next_place(next_place(i))],
              s.vertices[next_place(next_place(j))]};
}

Index FacetTriangles::flip(Index edge) {
  const auto [from, to, left, right] = *quad(edge);
  const auto both = sides(edge);
  for (const auto &[k, i] : both)
    unlink(k);
  remove_edge(edge);
  triangles_[both[0].triangle].vertices = {left, from, right};
  triangles_[both[1].triangle].vertices = {left, right, to};
  for (const auto &[k, i] : both)
    link(k);
  return find(left, right);
}

std::vector<Index> FacetTriangles::flip_required(Index edge, ExactPoints &points) {
  const Index diagonal = flip(edge);
  std::vector<Index> required;
  for (const auto &[k, i] : sides(diagonal)) {
    add_plane(k, points);
    for (const Index e : triangles_[k].edges) {
      if (!is_required(e))
        require(e);
      if (is_flat(e))
        required.push_back(e);
    }
  }
  return required;
}

} // namespace anistar::generate
