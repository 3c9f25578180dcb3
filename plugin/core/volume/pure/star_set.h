#pragma once
// The star set S(V), T(V) of RR-7712, section 7.1: of every site the star in its own
// metric, restricted to the domain and to its surfaces.

#include "volume/pure/domain_oracle.h"
#include "volume/pure/star.h"

namespace anistar {

/// Which stars a point concerns is found by looking through the boxes of all balls: a
/// few microseconds for the thousands of stars that such a set has, of the milliseconds
/// that an insertion takes.
class StarSet {
public:
  explicit StarSet(const DomainOracle &domain);

  [[nodiscard]] const DomainOracle &domain() const { return domain_; }
  [[nodiscard]] std::size_t size() const { return sites_.size(); }
  [[nodiscard]] const Site &site(Index v) const { return sites_[v]; }
  [[nodiscard]] const Star &star(Index v) const { return stars_[v]; }

  /// The stars in which a point lies in the ball of a cell.
  [[nodiscard]] std::vector<Index> in_conflict(const Vector<3> &x, double weight) const;
  /// The star that a new site would have.
  /// @param near sites that are likely to be in its link
  [[nodiscard]] Star star_of(const Site &site, std::span<const Index> near) const;
  /// Algorithm 1. @returns the sites whose stars have other simplices now, or hold a
  /// simplex that another star has got or lost
  std::vector<Index> insert(const Site &site);

  /// Whether the cell of v and these is in the restricted star of v.
  [[nodiscard]] bool has_cell(Index v, const StarSimplex &others, Index region) const;
  /// Whether the facet of v, a and b is in the restricted surface star of v.
  [[nodiscard]] bool has_facet(Index v, Index a, Index b) const;
  /// Whether some protecting ball holds the point, in the metric of its site or in that
  /// of the point.
  [[nodiscard]] Index protected_by(const Vertex<3> &p) const;

  struct SurfaceFacet {
    Index star = none, a = none, b = none;
    SurfaceBall ball;
    [[nodiscard]] bool exists() const { return star != none; }
  };
  /// A surface facet whose surface ball holds a point.
  [[nodiscard]] SurfaceFacet encroached(const Vector<3> &x) const;

  /// Calls visit(triangle, sorted sites) for the cells of the restricted star of v.
  template <class Visit> void each_cell(Index v, Visit visit) const {
    const Star &s = star(v);
    for (std::size_t k = 0; k < s.link().size(); ++k)
      if (s.link()[k].region != none)
        visit(s.link()[k], s.sorted(k));
  }
  /// Calls visit(a, b, ball) for the facets of the restricted surface star of v.
  template <class Visit> void each_facet(Index v, Visit visit) const {
    const Star &s = star(v);
    for (std::size_t k = 0; k < s.link().size(); ++k) {
      const LinkTriangle &t = s.link()[k];
      for (std::size_t i = 0; i < 3; ++i) {
        const Index a = s.site(t, (i + 1) % 3), b = s.site(t, (i + 2) % 3);
        if (t.across[i] > k && t.sides[i].exists() && !Star::is_mirror(a) &&
            !Star::is_mirror(b))
          visit(a, b, t.sides[i]);
      }
    }
  }

private:
  const DomainOracle &domain_;
  Box<3> enclosure_; ///< of the domain, with room around it
  std::vector<Site> sites_;
  std::vector<Vector<3>> places_; ///< of the sites
  std::vector<Star> stars_;
  std::vector<Box<3>> boxes_;         ///< of the balls of every star
  std::vector<Box<3>> surface_boxes_; ///< of its surface balls
  std::vector<Index> protected_;      ///< sites with a protecting ball

  void add(const Site &site, Star &&star);
  void restrict_to_domain(Index v);
  void keep_boxes(Index v);
};

} // namespace anistar
