#pragma once
// The metric field that the input mesh carries.

#include "base/parallel.h"
#include "base/range.h"
#include "mesh/measures.h"
#include "search/locator.h"

namespace anistar {

/// The eigenvalues of an interpolated metric differ by at most e^32.28 = 1.05e14.
/// Interpolation adds nothing to the range of the logarithms of metrics, which is that
/// of 1e14, but round-off does, by up to 4 %: what is raised here is no more than that,
/// and the result is taken for a metric again, as the door leaves 10 % to round-off.
inline constexpr double largest_range = 32.28;

/// exp L, for logarithms L of eigenvalues no further apart than `largest_range`; else
/// the smaller ones are raised.
template <std::size_t d>
[[nodiscard]] SymmetricTensor<d> definite_exp(const SymmetricTensor<d> &L) {
  double trace = 0, squares = 0;
  for (std::size_t i = 0; i < d; ++i)
    trace += L(i, i);
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = 0; j < d; ++j) {
      const double entry = L(i, j) - (i == j ? trace / double(d) : 0);
      squares += entry * entry;
    }
  // the sum of (l_i - mean)^2 is at least half of the range squared
  if (2 * squares <= largest_range * largest_range)
    return exp<d>(L);
  Spectrum<d> s = spectrum(L);
  const double least = s.values.maxCoeff() - largest_range;
  for (int k = 0; k < static_cast<int>(d); ++k)
    s.values[k] = elementary::exp(std::max(s.values[k], least));
  return compose<d>(s.values, s.vectors);
}

/// P1 interpolation of log M on the given mesh: positive definite everywhere, and a
/// mean of sizes rather than of their inverse squares (Arsigny, Fillard, Pennec,
/// Ayache, Log-Euclidean metrics, 2006). Points outside take the value of the nearest
/// point.
template <std::size_t d> class Background {
public:
  /// @pre every metric is positive definite in double precision.
  /// @throws std::domain_error if one has no finite logarithm.
  Background(std::span<const Vector<d>> points, std::span<const Cell<d>> cells,
             std::span<const SymmetricTensor<d>> metric, int threads = 1)
      : locator_(points, cells, threads), logarithm_(metric.size()) {
    parallel_ranges(metric.size(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        logarithm_[v] = finite_log(metric[v]);
    });
  }

  /// @param cell hint for the location in, cell found out.
  [[nodiscard]] SymmetricTensor<d> metric(const Vector<d> &x, Index &cell) const {
    const Location<d> at = locator_.locate(x, cell);
    cell = at.cell;
    SymmetricTensor<d> L;
    for (std::size_t i = 0; i <= d; ++i)
      L += at.barycentric[i] * logarithm_[locator_.cells()[cell][i]];
    return definite_exp<d>(L);
  }

  [[nodiscard]] Vertex<d> vertex(const Vector<d> &x, Index &cell) const {
    return make_vertex<d>(x, metric(x, cell));
  }

  /// The points of the given mesh, as vertices with their metric.
  [[nodiscard]] std::vector<Vertex<d>> vertices(int threads) const {
    std::vector<Vertex<d>> out(logarithm_.size());
    parallel_ranges(out.size(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        out[v] = make_vertex<d>(locator_.points()[v], definite_exp<d>(logarithm_[v]));
    });
    return out;
  }

  [[nodiscard]] const Locator<d> &locator() const { return locator_; }

private:
  Locator<d> locator_;
  std::vector<SymmetricTensor<d>> logarithm_;

  [[nodiscard]] static SymmetricTensor<d> finite_log(const SymmetricTensor<d> &M) {
    const SymmetricTensor<d> L = log<d>(M);
    for (const double entry : L.entries)
      if (!std::isfinite(entry))
        throw out_of_range("a metric has no finite logarithm", M.entries);
    return L;
  }
};

} // namespace anistar
