#pragma once
// The facets of a complex, as triangles that are split with their edges and may flip
// within a facet, and the edges that the mesh must have for them.

#include "generate/constrained/facets/edge_table.h"
#include "generate/constrained/points/exact_points.h"
#include "generate/plc.h"

#include <array>
#include <optional>
#include <vector>

namespace anistar::generate {

/// An edge of the complex, or an edge between two triangles of a facet that do not lie
/// on one plane, as it was before anything was placed on it.
struct Line {
  Index from, to;
  Index segment; ///< of the complex, `none` for an edge within a facet

  [[nodiscard]] bool is_flat() const { return segment == none; }
};

/// A triangle of a facet, seen from its edge from vertex i to vertex i + 1.
struct TriangleSide {
  Index triangle;
  std::size_t place;
};

class FacetTriangles {
public:
  struct Triangle {
    Facet<3> vertices;
    std::array<Index, 3> edges; ///< edge i joins vertices i and i + 1
    std::array<Index, 3> next;  ///< the code of the next side at the same edge
    Index facet;
    Index plane = none; ///< `none` for a triangle without area
  };
  struct Edge {
    Index from, to;
    Index first = none; ///< the code of a side
    Index line = none;  ///< `none`: the mesh need not have this edge
    bool is_alive = true;
  };

  explicit FacetTriangles(const Plc &plc);

  [[nodiscard]] const std::vector<Triangle> &triangles() const { return triangles_; }
  [[nodiscard]] const std::vector<Edge> &edges() const { return edges_; }
  [[nodiscard]] const std::vector<Line> &lines() const { return lines_; }
  /// For each plane three points, in the sense of the triangles on it.
  [[nodiscard]] const std::vector<Facet<3>> &planes() const { return planes_; }
  [[nodiscard]] Index find(Index a, Index b) const { return table_.find(a, b); }
  [[nodiscard]] bool is_required(Index edge) const { return edges_[edge].line != none; }
  [[nodiscard]] bool is_flat(Index edge) const {
    return is_required(edge) && lines_[edges_[edge].line].is_flat();
  }
  /// Whether there is an edge between two points which is part of a segment.
  [[nodiscard]] bool is_segment(Index a, Index b) const {
    const Index edge = find(a, b);
    return edge != none && is_required(edge) && !is_flat(edge);
  }
  [[nodiscard]] std::vector<TriangleSide> sides(Index edge) const;
  /// The triangles of each plane.
  [[nodiscard]] std::vector<std::vector<Index>> triangles_by_plane() const;

  /// The facet that each plane is part of.
  [[nodiscard]] std::vector<Index> facets_of_planes() const;

  /// Joins triangles of one facet that lie exactly on one plane, across edges that are
  /// no segments, and requires all other edges.
  void find_planes(ExactPoints &points);

  /// Divides an edge, with the triangles at it, at a point. @returns its two parts
  std::array<Index, 2> split(Index edge, Index p);

  /// The four corners about an edge between two triangles.
  struct Quad {
    Index from, to, left, right;
  };
  /// Of an edge that is no segment between just two triangles of one facet.
  [[nodiscard]] std::optional<Quad> quad(Index edge) const;
  /// Puts the other diagonal in the place of an edge. @pre quad(edge), which is convex
  Index flip(Index edge);
  /// The same for triangles that have planes: they get new ones, and all their edges
  /// are required from now on. @returns those of their edges that are no segments
  std::vector<Index> flip_required(Index edge, ExactPoints &points);

private:
  std::vector<Triangle> triangles_;
  std::vector<Edge> edges_;
  std::vector<Line> lines_;
  std::vector<Facet<3>> planes_;
  EdgeTable table_;

  Index add_edge(Index a, Index b, Index line);
  void remove_edge(Index edge);
  void link(Index triangle);
  void unlink(Index triangle);
  void require(Index edge);
  Index add_plane(Index triangle, ExactPoints &points);
  void flood_plane(Index seed, ExactPoints &points);
  [[nodiscard]] Index same_facet_across(const Triangle &triangle,
                                        std::size_t place) const;
};

} // namespace anistar::generate
