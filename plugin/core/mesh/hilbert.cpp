#include "mesh/hilbert.h"

#include "base/parallel.h"

#include <algorithm>
#include <utility>

namespace anistar {
namespace {

/// Bits per axis; d of them fill a 64-bit key.
template <std::size_t d> inline constexpr int bits = d == 2 ? 26 : 20;

/// Position along the curve, by the transpose algorithm of J. Skilling, Programming the
/// Hilbert curve, AIP Conf. Proc. 707 (2004).
template <std::size_t d> std::uint64_t hilbert_key(std::array<std::uint32_t, d> x) {
  const std::uint32_t top = 1u << (bits<d> - 1);
  for (std::uint32_t q = top; q > 1; q >>= 1) {
    const std::uint32_t p = q - 1;
    for (std::size_t i = 0; i < d; ++i) {
      // without a branch, which would be taken at random: turn x[0], or swap with it
      const std::uint32_t is_set = 0u - ((x[i] & q) != 0);
      const std::uint32_t t = (x[0] ^ x[i]) & p & ~is_set;
      x[0] ^= (p & is_set) | t;
      x[i] ^= t;
    }
  }
  for (std::size_t i = 1; i < d; ++i)
    x[i] ^= x[i - 1];
  std::uint32_t t = 0;
  for (std::uint32_t q = top; q > 1; q >>= 1)
    if (x[d - 1] & q)
      t ^= q - 1;
  for (std::uint32_t &xi : x)
    xi ^= t;
  std::uint64_t key = 0;
  for (int bit = bits<d> - 1; bit >= 0; --bit)
    for (std::size_t i = 0; i < d; ++i)
      key = key << 1 | (x[i] >> bit & 1u);
  return key;
}

} // namespace

template <std::size_t d>
std::vector<std::int32_t> hilbert_order(std::span<const Vector<d>> points, int threads,
                                        double shift) {
  Vector<d> low = Vector<d>::Zero(), high = Vector<d>::Zero();
  if (!points.empty())
    low = high = points.front();
  for (const Vector<d> &p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double inner = std::max((high - low).maxCoeff(), 1e-300);
  const double extent = (1 + 3 * shift) * inner;
  low.array() -= shift * inner;
  const double cells = static_cast<double>((1u << bits<d>)-1);
  std::vector<std::pair<std::uint64_t, std::int32_t>> keyed(points.size());
  parallel_ranges(points.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      std::array<std::uint32_t, d> x;
      for (std::size_t i = 0; i < d; ++i)
        x[i] = static_cast<std::uint32_t>(
            (points[k][static_cast<int>(i)] - low[static_cast<int>(i)]) / extent *
            cells);
      keyed[k] = {hilbert_key<d>(x), static_cast<std::int32_t>(k)};
    }
  });
  parallel_sort(keyed, threads);
  std::vector<std::int32_t> order(points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    order[k] = keyed[k].second;
  return order;
}

template std::vector<std::int32_t> hilbert_order<2>(std::span<const Vector<2>>, int,
                                                    double);
template std::vector<std::int32_t> hilbert_order<3>(std::span<const Vector<3>>, int,
                                                    double);

} // namespace anistar
