#include "metric/bounded_distortion.h"

#include "mesh/statistics.h"

namespace anistar {
namespace {

/// Directions that cover the circle, or the sphere: the axes and the diagonals.
template <std::size_t d> std::vector<Vector<d>> directions() {
  std::vector<Vector<d>> out;
  if constexpr (d == 2) {
    constexpr int n = 8;
    for (int k = 0; k < n; ++k) {
      const auto [sine, cosine] = elementary::sine_cosine(2 * std::numbers::pi * k / n);
      out.emplace_back(cosine, sine);
    }
  } else {
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          if (const int n = x * x + y * y + z * z; n == 1 || n == 3)
            out.emplace_back(Vector<3>(x, y, z) / std::sqrt(n));
  }
  return out;
}

/// Whether no two of the metrics at a vertex and around it, at half a distance and the
/// whole of it, differ by more than gamma_0.
template <std::size_t d>
bool varies_little(const Background<d> &background, const Vertex<d> &at, Index cell,
                   const SymmetricTensor<d> &root, double distance, double gamma_0) {
  static const std::vector<Vector<d>> around = directions<d>();
  std::vector<SymmetricTensor<d>> samples{at.M};
  for (double r : {distance, .5 * distance})
    for (const Vector<d> &direction : around) {
      Index hint = cell;
      const SymmetricTensor<d> M =
          background.metric(at.x + product<d>(root, Vector<d>(r * direction)), hint);
      for (const SymmetricTensor<d> &other : samples)
        if (distortion(M, other) > gamma_0)
          return false;
      samples.push_back(M);
    }
  return true;
}

} // namespace

template <std::size_t d>
double bounded_distortion_radius(const Background<d> &background, const Vertex<d> &at,
                                 Index cell, double gamma_0) {
  constexpr double largest = 2, smallest = .05, ratio = .8;
  const SymmetricTensor<d> root =
      matrix_function(at.M, [](double x) { return 1 / std::sqrt(x); });
  for (double l = largest; l > smallest; l *= ratio)
    if (varies_little(background, at, cell, root, l, gamma_0))
      return l;
  return smallest;
}

template double bounded_distortion_radius(const Background<2> &, const Vertex<2> &,
                                          Index, double);
template double bounded_distortion_radius(const Background<3> &, const Vertex<3> &,
                                          Index, double);

} // namespace anistar
