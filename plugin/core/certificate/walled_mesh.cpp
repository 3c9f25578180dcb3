#include "certificate/walled_mesh.h"

#include <algorithm>
#include <utility>

namespace anistar {

namespace {

/// Finds facets, in any orientation, among given ones.
template <std::size_t d> class KnownFacets {
public:
  KnownFacets(std::span<const Facet<d>> facets, std::size_t n_points)
      : is_on_one_(n_points, false) {
    facets_.reserve(facets.size());
    for (const Facet<d> &given : facets) {
      facets_.emplace_back(given, static_cast<Index>(facets_.size()));
      Facet<d> &facet = facets_.back().first;
      std::sort(facet.begin(), facet.end());
      for (Index v : facet)
        is_on_one_[v] = true;
    }
    std::sort(facets_.begin(), facets_.end());
  }

  [[nodiscard]] std::size_t size() const { return facets_.size(); }
  /// Its place among them, `none` where it is none of them.
  [[nodiscard]] Index find(Facet<d> facet) const {
    for (Index v : facet)
      if (!is_on_one_[v])
        return none;
    std::sort(facet.begin(), facet.end());
    const auto at =
        std::lower_bound(facets_.begin(), facets_.end(), std::pair(facet, Index{0}));
    return at != facets_.end() && at->first == facet ? at->second : none;
  }

private:
  std::vector<std::pair<Facet<d>, Index>> facets_; ///< sorted, with their places
  std::vector<bool> is_on_one_;
};

} // namespace

template <std::size_t d>
std::vector<std::array<Index, d + 1>> walls(std::span<const Cell<d>> cells,
                                            std::span<const Facet<d>> facets,
                                            std::size_t n_points) {
  const KnownFacets<d> known(facets, n_points);
  std::vector<std::array<Index, d + 1>> out(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t i = 0; i <= d; ++i)
      out[c][i] = known.find(facet_of<d>(cells[c], i));
  return out;
}

template <std::size_t d>
bool has_interfaces(std::span<const Cell<d>> cells, std::span<const Facet<d>> facets,
                    std::size_t n_points) {
  const KnownFacets<d> known(facets, n_points);
  std::vector<bool> has_cell(known.size(), false);
  for (const Cell<d> &cell : cells)
    for (std::size_t i = 0; i <= d; ++i)
      if (const Index k = known.find(facet_of<d>(cell, i)); k != none) {
        if (has_cell[k])
          return true;
        has_cell[k] = true;
      }
  return false;
}

template <std::size_t d>
WalledMesh<d>::WalledMesh(std::span<const Vertex<d>> vertices,
                          std::span<const Cell<d>> cells,
                          std::span<const Facet<d>> facets)
    : vertices_(vertices), cells_(cells),
      neighbours_(adjacency<d>(cells, vertices.size())),
      walls_(walls<d>(cells, facets, vertices.size())) {}

template <std::size_t d> void WalledMesh<d>::open_interfaces() {
  for (std::size_t c = 0; c < cells_.size(); ++c)
    for (std::size_t i = 0; i <= d; ++i)
      if (neighbours_[c][i].exists())
        walls_[c][i] = none;
}

template std::vector<std::array<Index, 3>>
    walls<2>(std::span<const Cell<2>>, std::span<const Facet<2>>, std::size_t);
template std::vector<std::array<Index, 4>>
    walls<3>(std::span<const Cell<3>>, std::span<const Facet<3>>, std::size_t);
template bool has_interfaces<2>(std::span<const Cell<2>>, std::span<const Facet<2>>,
                                std::size_t);
template bool has_interfaces<3>(std::span<const Cell<3>>, std::span<const Facet<3>>,
                                std::size_t);
template class WalledMesh<2>;
template class WalledMesh<3>;

} // namespace anistar
