#include "certificate/certify.h"

#include "base/parallel.h"
#include "certificate/sharp_corners.h"
#include "mesh/statistics.h"
#include "search/locator.h"

#include <optional>

namespace anistar {
namespace {

constexpr std::size_t cells_between_looks = 1024;

template <std::size_t d> class Certifier {
public:
  Certifier(std::span<const Vertex<d>> vertices, std::span<const Cell<d>> cells,
            std::span<const Facet<d>> facets, int threads,
            const std::function<void()> &look)
      : vertices_(vertices), cells_(cells), threads_(threads), look_(look),
        neighbours_(adjacency<d>(cells, vertices.size())),
        walls_(walls<d>(cells, facets, vertices.size())) {}

  CertificateResult run() const {
    CertificateResult out;
    out.delaunay = bits(walls_);
    out.star_ok = stars(out.delaunay);
    out.simplex_ok.resize(cells_.size());
    for (std::size_t c = 0; c < cells_.size(); ++c)
      out.simplex_ok[c] = out.delaunay[c] == all_vertices<d>;
    measure_shapes(out);
    measure_distortion(out);
    out.exempt = exempt_vertices<d>(mesh(walls_), out.star_ok);
    out.stars_without_interfaces = without_interfaces(out.star_ok);
    count_restricted(out);
    return out;
  }

private:
  using Walls = std::vector<std::array<Index, d + 1>>;

  std::span<const Vertex<d>> vertices_;
  std::span<const Cell<d>> cells_;
  int threads_;
  const std::function<void()> &look_;
  std::vector<Neighbours<d>> neighbours_;
  Walls walls_;

  [[nodiscard]] const Vertex<d> &vertex(Index v) const { return vertices_[v]; }
  [[nodiscard]] Simplex<d> simplex(std::size_t c) const {
    Simplex<d> s;
    for (std::size_t k = 0; k <= d; ++k)
      s[k] = vertex(cells_[c][k]).x;
    return s;
  }
  [[nodiscard]] CertifiedMesh<d> mesh(const Walls &constraints) const {
    return {vertices_, cells_, neighbours_, constraints};
  }

  [[nodiscard]] std::vector<std::uint8_t> bits(const Walls &constraints) const {
    return delaunay_bits<d>(mesh(constraints), threads_,
                            [&](double) {
                              look_();
                              return true;
                            })
        .bits;
  }

  [[nodiscard]] std::vector<std::uint8_t>
  stars(const std::vector<std::uint8_t> &bits) const {
    std::vector<std::uint8_t> ok(vertices_.size(), 1);
    for (std::size_t c = 0; c < cells_.size(); ++c)
      for (std::size_t k = 0; k <= d; ++k)
        if ((bits[c] >> k & 1) == 0)
          ok[cells_[c][k]] = 0;
    return ok;
  }

  void measure_shapes(CertificateResult &out) const {
    out.radius_edge.assign(cells_.size(), 0);
    out.sliverity.assign(cells_.size(), 0);
    parallel_ranges(cells_.size(), threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c)
        measure_shape(c, out.radius_edge[c], out.sliverity[c]);
    });
  }

  void measure_shape(std::size_t c, double &radius_edge, double &sliver) const {
    const Simplex<d> s = simplex(c);
    const double volume = anistar::volume<d>(s);
    for (Index v : cells_[c]) {
      const double shortest = shortest_length<d>(vertex(v).M, s);
      const double ratio = circumsphere<d>(vertex(v).M, s).radius / shortest;
      const double thinness = sliverity<d>(volume / vertex(v).weight, shortest);
      radius_edge = std::max(radius_edge, ratio);
      sliver = v == cells_[c][0] ? thinness : std::min(sliver, thinness);
    }
  }

  void measure_distortion(CertificateResult &out) const {
    const auto edges = edges_of<d>(cells_, vertices_.size());
    std::vector<double> gamma(edges.size());
    parallel_ranges(edges.size(), threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e)
        gamma[e] = anistar::distortion(vertex(edges[e][0]).M, vertex(edges[e][1]).M);
    });
    out.distortion.assign(vertices_.size(), 1);
    for (std::size_t e = 0; e < edges.size(); ++e)
      for (Index v : edges[e]) {
        double &worst = out.distortion[v];
        worst = std::max(worst, gamma[e]);
      }
  }

  [[nodiscard]] std::size_t
  without_interfaces(const std::vector<std::uint8_t> &star_ok) const {
    Walls boundary = walls_;
    bool has_interface = false;
    for (std::size_t c = 0; c < cells_.size(); ++c)
      for (std::size_t i = 0; i <= d; ++i)
        if (walls_[c][i] != none && neighbours_[c][i].exists()) {
          boundary[c][i] = none;
          has_interface = true;
        }
    const auto count = [](const std::vector<std::uint8_t> &ok) {
      return static_cast<std::size_t>(std::count(ok.begin(), ok.end(), 1));
    };
    if (!has_interface)
      return count(star_ok);
    return count(stars(bits(boundary)));
  }

  void count_restricted(CertificateResult &out) const {
    std::optional<Locator<d>> locator; // few centres are not found by a short walk
    const auto is_inside = [&](const Vector<d> &x, Index start) {
      const Index found = walk(x, start);
      if (found != none)
        return true;
      if (!locator) {
        std::vector<Vector<d>> points;
        for (const Vertex<d> &v : vertices_)
          points.push_back(v.x);
        locator.emplace(points, cells_);
      }
      return locator->locate(x, none).distance == 0;
    };
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      if (c % cells_between_looks == 0)
        look_();
      const Cell<d> &cell = cells_[c];
      std::uint8_t counts = 0;
      for (std::size_t k = 0; k <= d; ++k)
        if (is_inside(circumsphere<d>(vertex(cell[k]).M, simplex(c)).centre,
                      static_cast<Index>(c)))
          counts = static_cast<std::uint8_t>(counts | 1u << k);
      const bool in_all =
          counts == all_vertices<d> && out.delaunay[c] == all_vertices<d>;
      out.restricted_v2 += counts != 0;
      out.restricted_v2_ok += in_all;
      out.restricted_v1 += counts == all_vertices<d>;
      out.restricted_v1_ok += in_all;
    }
  }

  [[nodiscard]] Index walk(const Vector<d> &x, Index start) const {
    Index c = start;
    for (int step = 0; step < 32; ++step) {
      HalfFacet out;
      bool crossed = false;
      for (std::size_t i = 0; i <= d && !crossed; ++i) {
        Simplex<d> replaced = simplex(c);
        replaced[i] = x;
        if (orientation<d>(replaced) == Orientation::negative) {
          out = neighbours_[c][i];
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

template <std::size_t d>
std::vector<std::array<Index, d + 1>> walls(std::span<const Cell<d>> cells,
                                            std::span<const Facet<d>> facets,
                                            std::size_t n_points) {
  std::vector<bool> on_facet(n_points, false);
  std::vector<Facet<d>> known(facets.begin(), facets.end());
  for (Facet<d> &facet : known) {
    std::sort(facet.begin(), facet.end());
    for (Index v : facet)
      on_facet[v] = true;
  }
  std::sort(known.begin(), known.end());
  std::vector<std::array<Index, d + 1>> out(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t i = 0; i <= d; ++i) {
      Facet<d> facet = facet_of<d>(cells[c], i);
      std::sort(facet.begin(), facet.end());
      const bool may_be =
          std::all_of(facet.begin(), facet.end(), [&](Index v) { return on_facet[v]; });
      out[c][i] =
          may_be && std::binary_search(known.begin(), known.end(), facet) ? 0 : none;
    }
  return out;
}

template <std::size_t d>
CertificateResult certify(std::span<const Vertex<d>> vertices,
                          std::span<const Cell<d>> cells,
                          std::span<const Facet<d>> facets, int threads,
                          const std::function<void()> &look) {
  return Certifier<d>(vertices, cells, facets, threads, look).run();
}

template std::vector<std::array<Index, 3>>
    walls(std::span<const Cell<2>>, std::span<const Facet<2>>, std::size_t);
template std::vector<std::array<Index, 4>>
    walls(std::span<const Cell<3>>, std::span<const Facet<3>>, std::size_t);
template CertificateResult certify(std::span<const Vertex<2>>, std::span<const Cell<2>>,
                                   std::span<const Facet<2>>, int,
                                   const std::function<void()> &);
template CertificateResult certify(std::span<const Vertex<3>>, std::span<const Cell<3>>,
                                   std::span<const Facet<3>>, int,
                                   const std::function<void()> &);

} // namespace anistar
