#include "certify.h"

#include "locator.h"
#include "parallel.h"

#include <map>
#include <numbers>
#include <optional>
#include <set>

namespace anistar {
namespace {

/// Corners sharper than this may stay without a certificate, in this many vertices of
/// their first shell.
constexpr double sharp_corner = std::numbers::pi / 6;
constexpr int max_exempt = 8;

class Certifier {
public:
  Certifier(std::span<const Vertex<2>> vertices, std::span<const Cell<2>> cells,
            std::span<const Facet<2>> facets, int threads)
      : vertices_(vertices), cells_(cells), threads_(threads),
        neighbours_(adjacency<2>(cells, vertices.size())),
        walls_(walls(cells, facets, vertices.size())) {}

  CertificateResult run() {
    CertificateResult out;
    out.delaunay =
        delaunay_bits({vertices_, cells_, neighbours_, walls_}, threads_).bits;
    out.star_ok = stars(out.delaunay);
    out.simplex_ok.resize(cells_.size());
    for (std::size_t c = 0; c < cells_.size(); ++c)
      out.simplex_ok[c] = out.delaunay[c] == all_vertices;
    measure_shapes(out);
    find_exempt(out);
    out.stars_without_interfaces = without_interfaces(out.star_ok);
    count_restricted(out);
    return out;
  }

private:
  std::span<const Vertex<2>> vertices_;
  std::span<const Cell<2>> cells_;
  int threads_;
  std::vector<Neighbours<2>> neighbours_;
  std::vector<std::array<Index, 3>> walls_;
  std::map<Index, int> exempt_at_; ///< vertices exempt at each corner so far

  [[nodiscard]] const Vertex<2> &vertex(Index v) const {
    return vertices_[static_cast<std::size_t>(v)];
  }
  [[nodiscard]] bool is_wall(Index c, std::size_t i) const {
    return walls_[static_cast<std::size_t>(c)][i] != none;
  }

  [[nodiscard]] std::vector<std::uint8_t>
  stars(const std::vector<std::uint8_t> &bits) const {
    std::vector<std::uint8_t> ok(vertices_.size(), 1);
    for (std::size_t c = 0; c < cells_.size(); ++c)
      for (std::size_t k = 0; k < 3; ++k)
        if ((bits[c] >> k & 1) == 0)
          ok[static_cast<std::size_t>(cells_[c][k])] = 0;
    return ok;
  }

  void measure_shapes(CertificateResult &out) const {
    out.distortion.assign(vertices_.size(), 1);
    out.radius_edge.assign(cells_.size(), 0);
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const Cell<2> &cell = cells_[c];
      const Vector<2> &x0 = vertex(cell[0]).x, &x1 = vertex(cell[1]).x,
                      &x2 = vertex(cell[2]).x;
      for (std::size_t k = 0; k < 3; ++k) {
        const SymmetricTensor<2> &M = vertex(cell[k]).M;
        const double shortest =
            std::min({quadratic<2>(M, x1 - x0), quadratic<2>(M, x2 - x1),
                      quadratic<2>(M, x0 - x2)});
        out.radius_edge[c] =
            std::max(out.radius_edge[c],
                     circumcircle(M, x0, x1, x2).radius / std::sqrt(shortest));
        const Index a = cell[k], b = cell[(k + 1) % 3];
        const double gamma = anistar::distortion(vertex(a).M, vertex(b).M);
        for (Index v : {a, b}) {
          double &worst = out.distortion[static_cast<std::size_t>(v)];
          worst = std::max(worst, gamma);
        }
      }
    }
  }

  /// Walks around every corner of a wall; in sectors below the sharp angle the failing
  /// vertices of the first shell are exempt.
  void find_exempt(CertificateResult &out) {
    out.exempt.assign(vertices_.size(), 0);
    for (std::size_t c = 0; c < cells_.size(); ++c)
      for (std::size_t k = 0; k < 3; ++k)
        if (is_wall(static_cast<Index>(c), (k + 2) % 3)) // a sector begins here
          exempt_sector(static_cast<Index>(c), k, out);
  }

  void exempt_sector(Index first, std::size_t local, CertificateResult &out) {
    const Index apex = cells_[static_cast<std::size_t>(first)][local];
    std::vector<Index> shell{apex};
    double angle = 0;
    Index c = first;
    std::size_t k = local;
    for (std::size_t n = 0; n <= cells_.size(); ++n) {
      const Cell<2> &cell = cells_[static_cast<std::size_t>(c)];
      const Vector<2> u = vertex(cell[(k + 1) % 3]).x - vertex(apex).x;
      const Vector<2> v = vertex(cell[(k + 2) % 3]).x - vertex(apex).x;
      angle += std::atan2(cross(u, v), u.dot(v));
      shell.push_back(cell[(k + 1) % 3]);
      if (angle >= sharp_corner)
        return;
      if (is_wall(c, (k + 1) % 3)) {
        shell.push_back(cell[(k + 2) % 3]);
        break;
      }
      const HalfFacet next = neighbours_[static_cast<std::size_t>(c)][(k + 1) % 3];
      if (!next.exists())
        return;
      c = next.cell();
      const Cell<2> &beyond = cells_[static_cast<std::size_t>(c)];
      k = static_cast<std::size_t>(std::find(beyond.begin(), beyond.end(), apex) -
                                   beyond.begin());
    }
    int &n_exempt = exempt_at_[apex];
    for (Index v : shell)
      if (out.star_ok[static_cast<std::size_t>(v)] == 0 &&
          out.exempt[static_cast<std::size_t>(v)] == 0 && n_exempt < max_exempt) {
        out.exempt[static_cast<std::size_t>(v)] = 1;
        ++n_exempt;
      }
  }

  [[nodiscard]] std::size_t
  without_interfaces(const std::vector<std::uint8_t> &star_ok) const {
    std::vector<std::array<Index, 3>> boundary = walls_;
    bool has_interface = false;
    for (std::size_t c = 0; c < cells_.size(); ++c)
      for (std::size_t i = 0; i < 3; ++i)
        if (is_wall(static_cast<Index>(c), i) && neighbours_[c][i].exists()) {
          boundary[c][i] = none;
          has_interface = true;
        }
    const auto count = [](const std::vector<std::uint8_t> &ok) {
      return static_cast<std::size_t>(std::count(ok.begin(), ok.end(), 1));
    };
    if (!has_interface)
      return count(star_ok);
    return count(stars(
        delaunay_bits({vertices_, cells_, neighbours_, boundary}, threads_).bits));
  }

  void count_restricted(CertificateResult &out) const {
    std::optional<Locator<2>> locator; // few centres are not found by a short walk
    const auto is_inside = [&](const Vector<2> &x, Index start) {
      const Index found = walk(x, start);
      if (found != none)
        return true;
      if (!locator) {
        std::vector<Vector<2>> points;
        for (const Vertex<2> &v : vertices_)
          points.push_back(v.x);
        locator.emplace(points, cells_);
      }
      return locator->locate(x, none).distance == 0;
    };
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const Cell<2> &cell = cells_[c];
      std::uint8_t counts = 0;
      for (std::size_t k = 0; k < 3; ++k)
        if (is_inside(circumcircle(vertex(cell[k]).M, vertex(cell[0]).x,
                                   vertex(cell[1]).x, vertex(cell[2]).x)
                          .centre,
                      static_cast<Index>(c)))
          counts = static_cast<std::uint8_t>(counts | 1u << k);
      const bool in_all = counts == all_vertices && out.delaunay[c] == all_vertices;
      out.restricted_v2 += counts != 0;
      out.restricted_v2_ok += in_all;
      out.restricted_v1 += counts == all_vertices;
      out.restricted_v1_ok += in_all;
    }
  }

  [[nodiscard]] Index walk(const Vector<2> &x, Index start) const {
    Index c = start;
    for (int step = 0; step < 32; ++step) {
      HalfFacet out;
      bool crossed = false;
      for (std::size_t i = 0; i < 3 && !crossed; ++i) {
        const auto [a, b] = facet_of<2>(cells_[static_cast<std::size_t>(c)], i);
        if (orientation(vertex(a).x, vertex(b).x, x) == Orientation::negative) {
          out = neighbours_[static_cast<std::size_t>(c)][i];
          crossed = true;
        }
      }
      if (!crossed)
        return c;
      if (!out.exists())
        return none;
      c = out.cell();
    }
    return none;
  }
};

} // namespace

std::vector<std::array<Index, 3>> walls(std::span<const Cell<2>> cells,
                                        std::span<const Facet<2>> facets,
                                        std::size_t n_points) {
  std::vector<bool> on_facet(n_points, false);
  std::set<std::pair<Index, Index>> known;
  for (const Facet<2> &f : facets) {
    known.insert(std::minmax(f[0], f[1]));
    on_facet[static_cast<std::size_t>(f[0])] = true;
    on_facet[static_cast<std::size_t>(f[1])] = true;
  }
  std::vector<std::array<Index, 3>> out(cells.size(), {none, none, none});
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = facet_of<2>(cells[c], i);
      if (on_facet[static_cast<std::size_t>(a)] &&
          on_facet[static_cast<std::size_t>(b)] && known.contains(std::minmax(a, b)))
        out[c][i] = 0;
    }
  return out;
}

CertificateResult certify(std::span<const Vertex<2>> vertices,
                          std::span<const Cell<2>> cells,
                          std::span<const Facet<2>> facets, int threads) {
  return Certifier(vertices, cells, facets, threads).run();
}

} // namespace anistar
