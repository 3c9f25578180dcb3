#pragma once
// Which facets of a volume mesh fail the five-metric test, or that of surface stars,
// remembered.

#include "certificate/facet_test.h"
#include "certificate/surface/wall_test.h"
#include "volume/stars/surface_normals.h"

#include <limits>
#include <variant>

namespace anistar {

/// What decides about a facet: of two cells, or of a surface.
using DecidingStar = std::variant<FacetStar, WallStar>;

/// Of a facet between two cells.
[[nodiscard]] FacetStar facet_star(const Triangulation<3> &mesh, HalfFacet h);
/// Of a facet of a patch, between the cells with these apexes; the second one is none
/// on the boundary.
[[nodiscard]] WallStar wall_star(const Triangulation<3> &mesh,
                                 const SurfaceNormals &normals, const Facet<3> &facet,
                                 Index patch, std::array<Index, 2> apexes);

[[nodiscard]] DecidingStar deciding_star(const Triangulation<3> &mesh,
                                         const SurfaceNormals &normals, HalfFacet h);
/// See facet_margin.
[[nodiscard]] inline double margin_of(const FacetStar &star) {
  return facet_margin(star);
}
/// See wall_margin; on curved surfaces somewhat more, for the normals that others find
/// for the finished mesh are not quite these.
[[nodiscard]] double margin_of(const WallStar &star);
[[nodiscard]] inline double margin_of(const DecidingStar &star) {
  return std::visit([](const auto &one) { return margin_of(one); }, star);
}

/// The vertices that decide about a facet: its own and those of its cells beside it.
class DecidingVertices {
public:
  DecidingVertices(const Triangulation<3> &mesh, HalfFacet h);

  [[nodiscard]] std::size_t size() const { return n_; }
  [[nodiscard]] Index operator[](std::size_t k) const { return vertices_[k]; }
  [[nodiscard]] auto begin() const { return vertices_.begin(); }
  [[nodiscard]] auto end() const {
    return vertices_.begin() + static_cast<std::ptrdiff_t>(n_);
  }

private:
  std::array<Index, 5> vertices_;
  std::size_t n_ = 4; ///< on the boundary
};

/// Rounded, but never to another sign.
[[nodiscard]] inline float as_margin(double margin) {
  const auto rounded = static_cast<float>(margin);
  constexpr float least = std::numeric_limits<float>::min();
  return margin > 0 ? std::max(rounded, least) : std::min(rounded, -least);
}

/// The facet as its first cell has it.
[[nodiscard]] inline HalfFacet first_side(const Triangulation<3> &mesh, HalfFacet h) {
  const HalfFacet beyond = mesh.opposite(h);
  return beyond.exists() && beyond < h ? beyond : h;
}

/// The margins of facets, each found once and kept on both sides of the facet until one
/// of its cells changes.
class FacetMargins {
public:
  /// @pre both outlive this object
  FacetMargins(const Triangulation<3> &mesh, const SurfaceNormals &normals)
      : mesh_(mesh), normals_(normals), known_(mesh.cells.size(), unknown_cell) {}

  [[nodiscard]] float at(HalfFacet h) {
    float &own = known_[h.cell()][h.facet()];
    if (own == unknown)
      look(h);
    return own;
  }
  [[nodiscard]] bool fails(HalfFacet h) { return at(h) > 0; }
  /// Finds all margins, each from the first cell of its facet.
  void fill(int threads);
  void put(HalfFacet h, float margin) {
    known_[h.cell()][h.facet()] = margin;
    if (const HalfFacet other = mesh_.opposite(h); other.exists())
      known_[other.cell()][other.facet()] = margin;
  }
  /// Of a cell that is new or has changed.
  void forget(Index c);
  /// For cells that were added to the mesh.
  void extend() { known_.resize(mesh_.cells.size(), unknown_cell); }

private:
  static constexpr float unknown = -2;
  static constexpr std::array<float, 4> unknown_cell{unknown, unknown, unknown,
                                                     unknown};
  const Triangulation<3> &mesh_;
  const SurfaceNormals &normals_;
  std::vector<std::array<float, 4>> known_;

  void look(HalfFacet h) {
    put(h, as_margin(margin_of(deciding_star(mesh_, normals_, h))));
  }
};

/// What agreement makes small. The failing facets count, but a sum of whole numbers has
/// no slope: facets that nearly fail are felt before, and so are flat cells.
struct AgreementCost {
  int failing = 0;
  double shortfall = 0; ///< of qualities below `poor`
  double nearness = 0;  ///< of margins above `-near`

  static constexpr double near = .01, poor = .35;

  void add_facet(double margin) {
    failing += margin > 0;
    nearness += std::max(0., margin + near);
  }
  void add_cell(double quality) { shortfall += std::max(0., poor - quality); }
  [[nodiscard]] double total() const { return failing + 3 * nearness + 4 * shortfall; }
};

} // namespace anistar
