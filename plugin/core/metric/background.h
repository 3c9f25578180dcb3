#pragma once
// The metric field that the input mesh carries.

#include "base/parallel.h"
#include "mesh/measures.h"
#include "search/locator.h"

namespace anistar {

/// P1 interpolation of log M on the given mesh: positive definite everywhere, and a
/// mean of sizes rather than of their inverse squares (Arsigny, Fillard, Pennec,
/// Ayache, Log-Euclidean metrics, 2006). Points outside take the value of the nearest
/// point.
template <std::size_t d> class Background {
public:
  /// @pre every metric is positive definite.
  Background(std::span<const Vector<d>> points, std::span<const Cell<d>> cells,
             std::span<const SymmetricTensor<d>> metric, int threads = 1)
      : locator_(points, cells, threads), logarithm_(metric.size()) {
    parallel_ranges(metric.size(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        logarithm_[v] = log<d>(metric[v]);
    });
  }

  /// @param cell hint for the location in, cell found out.
  [[nodiscard]] SymmetricTensor<d> metric(const Vector<d> &x, Index &cell) const {
    const Location<d> at = locator_.locate(x, cell);
    cell = at.cell;
    SymmetricTensor<d> L;
    for (std::size_t i = 0; i <= d; ++i)
      L +=
          at.barycentric[i] * logarithm_[static_cast<std::size_t>(
                                  locator_.cells()[static_cast<std::size_t>(cell)][i])];
    return exp<d>(L);
  }

  [[nodiscard]] Vertex<d> vertex(const Vector<d> &x, Index &cell) const {
    return make_vertex<d>(x, metric(x, cell));
  }

  [[nodiscard]] const Locator<d> &locator() const { return locator_; }

private:
  Locator<d> locator_;
  std::vector<SymmetricTensor<d>> logarithm_;
};

} // namespace anistar
