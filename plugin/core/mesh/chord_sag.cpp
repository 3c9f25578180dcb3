#include "mesh/chord_sag.h"

namespace anistar {
namespace {

/// Between two directions.
template <std::size_t d> double turn(const Vector<d> &u, const Vector<d> &v) {
  const double cosine = u.dot(v), uu = u.squaredNorm(), vv = v.squaredNorm();
  const double sine = std::sqrt(std::max(0., uu * vv - cosine * cosine));
  return elementary::angle_of(sine, cosine);
}

} // namespace

template <std::size_t d>
std::vector<double> polyline_sags(std::span<const Vector<d>> points,
                                  std::span<const std::array<Index, 2>> segments,
                                  const std::vector<bool> &is_smooth) {
  const auto at = [](Index v) { return static_cast<std::size_t>(v); };
  std::vector<std::array<Index, 2>> beside(points.size(), {none, none});
  for (const auto &[a, b] : segments)
    for (const auto &[v, other] : {std::pair{a, b}, std::pair{b, a}})
      if (is_smooth[at(v)])
        beside[at(v)][beside[at(v)][0] == none ? 0 : 1] = other;

  constexpr double unknown = -1;
  std::vector<double> curvature(points.size(), unknown);
  for (std::size_t v = 0; v < points.size(); ++v)
    if (const auto [a, b] = beside[v]; b != none) {
      const Vector<d> u = points[v] - points[at(a)], w = points[at(b)] - points[v];
      curvature[v] = 2 * turn<d>(u, w) / (u.norm() + w.norm());
    }
  const auto of = [&](Index v) {
    const auto [a, b] = beside[at(v)];
    if (b == none)
      return 0.;
    return borne_out(curvature[at(v)], std::max(curvature[at(a)], curvature[at(b)]));
  };
  std::vector<double> sags;
  sags.reserve(segments.size());
  for (const auto &[a, b] : segments)
    sags.push_back((points[at(b)] - points[at(a)]).squaredNorm() / 8 *
                   std::max(of(a), of(b)));
  return sags;
}

template std::vector<double> polyline_sags<2>(std::span<const Vector<2>>,
                                              std::span<const std::array<Index, 2>>,
                                              const std::vector<bool> &);
template std::vector<double> polyline_sags<3>(std::span<const Vector<3>>,
                                              std::span<const std::array<Index, 2>>,
                                              const std::vector<bool> &);

} // namespace anistar
