#pragma once
// The stars of all vertices at once, for meshes that do not change meanwhile.

#include "mesh/adjacency.h"

#include <numeric>
#include <span>
#include <vector>

namespace anistar {

/// The cells at every vertex, in increasing order. Nothing is assumed of how they hang
/// together: parts of a body may touch in a vertex.
template <std::size_t d> class VertexCells {
public:
  /// @param cells those without a first vertex are free, and at no vertex
  VertexCells(std::span<const Cell<d>> cells, std::size_t n_vertices)
      : end_(n_vertices + 1, 0) {
    for (const Cell<d> &cell : cells)
      if (cell[0] != none)
        for (Index v : cell)
          ++end_[v];
    std::exclusive_scan(end_.begin(), end_.end(), end_.begin(), std::size_t{0});
    stars_.resize(end_.back());
    for (std::size_t c = 0; c < cells.size(); ++c)
      if (cells[c][0] != none)
        for (std::size_t k = 0; k <= d; ++k) {
          std::size_t &end = end_[cells[c][k]]; // starts where the star does
          stars_[end++] = HalfFacet(static_cast<Index>(c), k);
        }
  }

  /// Where the star of v begins among those of all vertices, one after another.
  [[nodiscard]] std::size_t begin(std::size_t v) const {
    return v == 0 ? 0 : end_[v - 1];
  }
  /// The cells at v, each as the half-facet opposite v.
  [[nodiscard]] std::span<const HalfFacet> star(std::size_t v) const {
    return {stars_.data() + begin(v), end_[v] - begin(v)};
  }
  [[nodiscard]] std::size_t size() const { return stars_.size(); }

private:
  std::vector<std::size_t> end_;
  std::vector<HalfFacet> stars_;
};

} // namespace anistar
