#pragma once
// The star of a site in the Delaunay triangulation of all sites for its own metric.
//
// What is kept of Del_v(V) is the link of v: a closed surface of triangles, each of
// which makes a cell with v. A new site changes the star when it lies in the ball of
// one of them. Those cells go, and the new site is joined to the edges around them; a
// site that has left the link never returns, since the Voronoi cell of v, whose corners
// are the centres of the balls, only shrinks. So the link is all that is needed.
//
// Six mirror sites, the images of v in the sides of a box around the domain, in its
// metric, close the link before others do. They cut nothing off inside of the box.

#include "certificate/star_ball.h"
#include "search/box_tree.h"
#include "volume/pure/site.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace anistar {

/// Where the dual edge of a facet meets a surface: a surface Delaunay ball.
struct SurfaceBall {
  Index facet = none; ///< of the boundary that it is centred on
  Vector<3> centre = Vector<3>::Zero();
  double square_radius = 0; ///< in the metric of the star, orthogonal to the balls
  [[nodiscard]] bool exists() const { return facet != none; }
};

/// A cell or a facet of a star by its other sites, in increasing order, `none` first.
using StarSimplex = std::array<Index, 3>;

/// A triangle of the link, and what it says of the restricted stars.
struct LinkTriangle {
  std::array<std::uint16_t, 3> corners{}; ///< among the vertices of the link
  std::array<std::uint16_t, 3> across{};  ///< beyond the side opposite each corner
  StarBall<3> ball;
  Vector<3> centre;
  double square_radius = 0;
  bool is_new = true;
  Index region = none; ///< where the centre is; none: outside of the domain
  std::array<SurfaceBall, 3> sides; ///< of the facets of v and the opposite side
};

class Star {
public:
  /// @param box holds the domain, with room around it
  Star(Index v, const Site &site, const Box<3> &box);

  /// A site as this star sees it.
  struct Seen {
    Index site = none;
    Vector<3> x;
    double weight = 0;
    StarPoint<3> at{};
  };
  [[nodiscard]] Seen see(Index site, const Vector<3> &x, double weight) const;
  [[nodiscard]] bool lies_inside(const LinkTriangle &triangle, const Seen &p) const;
  [[nodiscard]] bool conflicts(const Seen &p) const;

  /// Algorithm 1 of the paper, in this star. @returns whether anything has changed
  /// @throws MeshingError when the star gets more cells than it has numbers for
  bool insert(const Seen &p);
  /// The sides (a, b) of the link that `p` would be joined to.
  void horizon(const Seen &p, std::vector<std::array<Index, 2>> &sides) const;

  [[nodiscard]] Index vertex() const { return vertex_.site; }
  [[nodiscard]] const SymmetricTensor<3> &metric() const { return M_; }
  [[nodiscard]] const Vector<3> &place() const { return vertex_.x; }
  [[nodiscard]] double weight() const { return vertex_.weight; }
  [[nodiscard]] const std::vector<LinkTriangle> &link() const { return link_; }
  [[nodiscard]] std::vector<LinkTriangle> &link() { return link_; }
  [[nodiscard]] const std::vector<Seen> &corners() const { return corners_; }
  [[nodiscard]] Index site(const LinkTriangle &t, std::size_t k) const {
    return corners_[t.corners[k]].site;
  }
  [[nodiscard]] static bool is_mirror(Index site) { return site < 0; }
  /// Whether a triangle makes a cell of sites.
  [[nodiscard]] bool is_cell(const LinkTriangle &t) const {
    return !is_mirror(site(t, 0)) && !is_mirror(site(t, 1)) && !is_mirror(site(t, 2));
  }
  /// The triangle with these sites, which are in increasing order.
  [[nodiscard]] std::optional<std::size_t> find(const StarSimplex &sites) const;
  /// The sites of a triangle in increasing order.
  [[nodiscard]] const StarSimplex &sorted(std::size_t triangle) const {
    return sorted_[triangle];
  }

  /// Holds all balls of the star.
  [[nodiscard]] const Box<3> &balls() const { return balls_; }
  /// In the metric of the star, beyond the square of its radius: negative inside.
  [[nodiscard]] double power(const Vector<3> &centre, double square_radius,
                             const Vector<3> &x) const {
    return quadratic<3>(M_, x - centre) - square_radius;
  }
  /// The ball about a centre that is orthogonal to that of the vertex.
  [[nodiscard]] double square_radius(const Vector<3> &centre) const {
    return quadratic<3>(M_, centre - vertex_.x) - vertex_.weight;
  }
  /// Half the sides of the box around a ball of radius one.
  [[nodiscard]] const Vector<3> &extents() const { return extents_; }

private:
  /// A side (a, b) of the link as the triangle `from` has it, and the triangle beyond.
  struct Side {
    std::uint16_t a, b, from, beyond;
  };
  SymmetricTensor<3> M_;
  StarFrame<3> frame_;
  Matrix<3> to_space_; ///< from the coordinates of the frame
  Vector<3> extents_;
  Seen vertex_;
  std::vector<Seen> corners_;
  std::vector<LinkTriangle> link_;
  std::vector<StarSimplex> sorted_; ///< sites of its triangles
  Box<3> balls_;

  void close(const Box<3> &box);
  void measure(LinkTriangle &t) const;
  [[nodiscard]] std::vector<std::uint8_t> conflict(const Seen &p) const;
  [[nodiscard]] std::vector<Side> rim(const std::vector<std::uint8_t> &inside) const;
  [[nodiscard]] bool is_cycle(const std::vector<Side> &sides) const;
  void insist_on_numbers(std::size_t n_more) const;
  void join(const std::vector<Side> &sides, std::uint16_t p);
  void drop(std::vector<std::uint8_t> &inside);
  void drop_corners();
  void gather();
};

} // namespace anistar
