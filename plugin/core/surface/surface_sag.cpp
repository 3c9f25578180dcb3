#include "surface/surface_sag.h"

#include "mesh/chord_sag.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace anistar {
namespace {

/// Edges that meet at an angle with a larger cosine are parts of one chain, which tell
/// nothing of each other.
constexpr double chain_cosine = .7;

/// An edge between two facets of one patch.
struct SmoothEdge {
  std::array<Index, 2> ends;
  std::array<std::size_t, 2> facets;
  std::array<double, 2>
      side;                ///< 1 where the surface bends away from the facet's normal
  Vector<3> along, across; ///< unit vectors, across between the two facets
  std::array<Vector<3>, 2> across_in; ///< and in the plane of each
  double length, turn, spread; ///< spread: between the middles of the facets, across
  double borne_turn = 0;

  [[nodiscard]] double curvature() const { return turn / spread; }
};

/// The second fundamental form of a facet.
using Shape = Matrix<3>;

class Sags {
public:
  Sags(const SurfaceInput &input, const Features &features)
      : in_(input), features_(features), at_point_(input.points.size()) {
    for (std::size_t f = 0; f < in_.facets.size(); ++f)
      for (Index v : in_.facets[f])
        at_point_[at(v)].push_back(f);
  }

  std::vector<double> run() {
    find_edges();
    for (SmoothEdge &edge : edges_)
      edge.borne_turn = edge.spread * borne_out(edge.curvature(), largest_around(edge));
    std::vector<double> sags = of_surfaces();
    add_ridges(sags);
    for (std::size_t f = 0; f < sags.size(); ++f)
      if (patch(f).is_frozen)
        sags[f] = 0;
    return sags;
  }

private:
  const SurfaceInput &in_;
  const Features &features_;
  std::vector<std::vector<std::size_t>> at_point_; ///< facets
  std::vector<SmoothEdge> edges_;
  std::vector<std::vector<std::size_t>> of_facet_; ///< its smooth edges

  static std::size_t at(Index v) { return static_cast<std::size_t>(v); }
  [[nodiscard]] const Vector<3> &point(Index v) const { return in_.points[at(v)]; }
  [[nodiscard]] const Patch &patch(std::size_t f) const {
    return features_.patches[at(features_.facet_patch[f])];
  }
  [[nodiscard]] Vector<3> normal(std::size_t f) const { ///< twice the area long
    const Facet<3> &t = in_.facets[f];
    return (point(t[1]) - point(t[0])).cross(point(t[2]) - point(t[0]));
  }
  [[nodiscard]] Index opposite(std::size_t f, const std::array<Index, 2> &ends) const {
    for (Index v : in_.facets[f])
      if (v != ends[0] && v != ends[1])
        return v;
    return ends[0];
  }

  void find_edges() {
    struct Side {
      std::array<Index, 2> ends;
      std::size_t facet;
    };
    std::vector<Side> sides;
    for (std::size_t f = 0; f < in_.facets.size(); ++f)
      if (!patch(f).is_planar)
        for (std::size_t i = 0; i < 3; ++i) {
          const Index a = in_.facets[f][i], b = in_.facets[f][(i + 1) % 3];
          sides.push_back({{std::min(a, b), std::max(a, b)}, f});
        }
    std::sort(sides.begin(), sides.end(), [](const Side &s, const Side &t) {
      return std::tie(s.ends, s.facet) < std::tie(t.ends, t.facet);
    });
    std::vector<std::array<Index, 2>> ridges;
    for (const RidgeSegment &ridge : features_.ridges)
      ridges.push_back({std::min(ridge.ends[0], ridge.ends[1]),
                        std::max(ridge.ends[0], ridge.ends[1])});
    std::sort(ridges.begin(), ridges.end());
    of_facet_.resize(in_.facets.size());
    for (std::size_t k = 0; k + 1 < sides.size();
         ++k) { // all but ridges have two sides
      const auto &[ends, f] = sides[k];
      const auto &[next_ends, g] = sides[k + 1];
      if (ends != next_ends || std::binary_search(ridges.begin(), ridges.end(), ends))
        continue;
      for (std::size_t facet : {f, g})
        of_facet_[facet].push_back(edges_.size());
      edges_.push_back(edge_between(ends, f, g));
    }
  }

  [[nodiscard]] SmoothEdge edge_between(const std::array<Index, 2> &ends, std::size_t f,
                                        std::size_t g) const {
    SmoothEdge edge{};
    edge.ends = ends;
    edge.facets = {f, g};
    const Vector<3> e = point(ends[1]) - point(ends[0]);
    edge.length = e.norm();
    edge.along = e / std::max(edge.length, 1e-300);
    std::array<Vector<3>, 2> height; // of the opposite corners above the edge
    for (std::size_t k = 0; k < 2; ++k) {
      const Vector<3> u = point(opposite(edge.facets[k], ends)) - point(ends[0]);
      height[k] = u - edge.along * edge.along.dot(u);
    }
    const double cosine = -height[0].dot(height[1]);
    edge.turn = elementary::angle_of(height[0].cross(height[1]).norm(), cosine);
    edge.spread = std::max((height[0].norm() + height[1].norm()) / 3, 1e-300);
    edge.across_in = {-height[0].normalized(), height[1].normalized()};
    edge.across = (edge.across_in[0] + edge.across_in[1]).normalized();
    for (std::size_t k = 0; k < 2; ++k)
      edge.side[k] = normal(edge.facets[k]).dot(height[1 - k]) < 0 ? 1 : -1;
    return edge;
  }

  /// The largest curvature across an edge among the edges around that are not of its
  /// own chain; negative when there are none.
  [[nodiscard]] double largest_around(const SmoothEdge &edge) const {
    double largest = -1;
    for (Index v : edge.ends)
      for (std::size_t f : at_point_[at(v)]) {
        if (features_.facet_patch[f] != features_.facet_patch[edge.facets[0]])
          continue;
        for (std::size_t k : of_facet_[f]) {
          const SmoothEdge &other = edges_[k];
          if (is_of_chain(edge, other))
            continue;
          const double cosine = other.across.dot(edge.across);
          largest = std::max(largest, other.curvature() * cosine * cosine);
        }
      }
    return largest;
  }

  [[nodiscard]] static bool is_of_chain(const SmoothEdge &a, const SmoothEdge &b) {
    const bool touch = a.ends[0] == b.ends[0] || a.ends[0] == b.ends[1] ||
                       a.ends[1] == b.ends[0] || a.ends[1] == b.ends[1];
    return touch && std::abs(a.along.dot(b.along)) > chain_cosine;
  }

  [[nodiscard]] std::vector<double> of_surfaces() const {
    std::vector<Shape> shapes(in_.facets.size(), Shape::Zero());
    for (const SmoothEdge &edge : edges_)
      for (std::size_t k = 0; k < 2; ++k) {
        const std::size_t f = edge.facets[k];
        const Vector<3> &across = edge.across_in[k];
        shapes[f] += edge.side[k] * edge.borne_turn * edge.length /
                     std::max(normal(f).norm(), 1e-300) * across * across.transpose();
      }
    std::vector<double> sags(in_.facets.size(), 0);
    for (std::size_t f = 0; f < sags.size(); ++f) // ridges hide what lies beyond them:
      if (!patch(f).is_planar)                    // a neighbour may see more
        for (Index v : in_.facets[f])
          for (std::size_t g : at_point_[at(v)])
            if (features_.facet_patch[g] == features_.facet_patch[f])
              sags[f] = std::max(sags[f], sag(f, shapes[g], normal(g).normalized()));
    return sags;
  }

  /// How far half the quadratic form of a facet with this normal lies from its linear
  /// interpolation on facet f, whose edges are bent into the plane of that facet.
  [[nodiscard]] double sag(std::size_t f, const Shape &shape,
                           const Vector<3> &plane) const {
    const Facet<3> &t = in_.facets[f];
    double largest = 0, sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector<3> e = point(t[(i + 1) % 3]) - point(t[i]);
      const Vector<3> bent = (e - plane * plane.dot(e)).normalized();
      const double form = e.squaredNorm() * bent.dot(shape * bent);
      largest = std::max(largest, std::abs(form) / 8);
      sum += form;
    }
    return std::max(largest, std::abs(sum) / 18);
  }

  void add_ridges(std::vector<double> &sags) const {
    std::vector<bool> is_smooth(in_.points.size());
    for (std::size_t v = 0; v < is_smooth.size(); ++v)
      is_smooth[v] = features_.dimension[v] == 1;
    std::vector<std::array<Index, 2>> segments;
    for (const RidgeSegment &ridge : features_.ridges)
      segments.push_back(ridge.ends);
    const std::vector<double> found = polyline_sags<3>(in_.points, segments, is_smooth);
    std::vector<double> largest(in_.points.size(), 0);
    for (std::size_t k = 0; k < segments.size(); ++k)
      for (Index v : segments[k])
        largest[at(v)] = std::max(largest[at(v)], found[k]);
    for (std::size_t f = 0; f < sags.size(); ++f) {
      const Facet<3> &t = in_.facets[f];
      sags[f] =
          std::max({sags[f], largest[at(t[0])], largest[at(t[1])], largest[at(t[2])]});
    }
  }
};

} // namespace

std::vector<double> surface_sags(const SurfaceInput &input, const Features &features) {
  return Sags(input, features).run();
}

} // namespace anistar
