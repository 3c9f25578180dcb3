#pragma once
// Which facets of a volume mesh fail the five-metric test, remembered.

#include "certificate/facet_test.h"
#include "volume/mesh/volume.h"

#include <limits>

namespace anistar {

/// The margins of facets (see facet_margin), each found once and kept on both sides of
/// the facet until one of its cells changes.
class FacetMargins {
public:
  explicit FacetMargins(const Triangulation<3> &mesh)
      : mesh_(mesh), known_(mesh.cells.size(), unknown_cell) {}

  /// Of a facet between two cells; `untested` at walls, which are not crossed.
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
    const HalfFacet other = mesh_.opposite(h);
    known_[other.cell()][other.facet()] = margin;
  }
  /// Of a cell that is new or has changed.
  void forget(Index c);
  /// For cells that were added to the mesh.
  void extend() { known_.resize(mesh_.cells.size(), unknown_cell); }

  static constexpr float untested = -1;

private:
  static constexpr float unknown = -2;
  static constexpr std::array<float, 4> unknown_cell{unknown, unknown, unknown,
                                                     unknown};
  const Triangulation<3> &mesh_;
  std::vector<std::array<float, 4>> known_;

  void look(HalfFacet h);
};

/// Rounded, but never to another sign.
[[nodiscard]] inline float as_margin(double margin) {
  const auto rounded = static_cast<float>(margin);
  constexpr float least = std::numeric_limits<float>::min();
  return margin > 0 ? std::max(rounded, least) : std::min(rounded, -least);
}

/// The vertices that decide about a facet. @pre it has another side.
[[nodiscard]] FacetStar facet_star(const Triangulation<3> &mesh, HalfFacet h);

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
