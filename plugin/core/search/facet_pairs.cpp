#include "search/facet_pairs.h"

#include "search/box_tree.h"

#include <algorithm>
#include <limits>

namespace anistar {
namespace {

/// A bound of the relative errors of the few operations below.
constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();

/// The extent of a facet along an axis.
template <std::size_t d> struct Extent {
  Vector<d> axis; ///< unit vector, or zero: the facet has no such axis
  double low, high;
  double error; ///< of the axis, as an angle
};

template <std::size_t d> struct Extents {
  std::array<Extent<d>, d == 2 ? 2 : 4> along;
  double size; ///< length of the diagonal of its box
};

template <std::size_t d> using Corners = std::array<Vector<d>, d>;

std::array<Vector<2>, 2> axes(const Corners<2> &corner) {
  const Vector<2> e = corner[1] - corner[0];
  return {e, Vector<2>(-e[1], e[0])};
}

std::array<Vector<3>, 4> axes(const Corners<3> &corner) {
  const Vector<3> normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  std::array<Vector<3>, 4> all{normal};
  for (std::size_t k = 0; k < 3; ++k)
    all[k + 1] = normal.cross(corner[(k + 1) % 3] - corner[k]);
  return all;
}

template <std::size_t d> Extents<d> extents_of(const Corners<d> &corner, double size) {
  Extents<d> out{{}, size};
  const auto all = axes(corner);
  const double shortest = d == 2 ? size : all[0].norm() / size; // a height of the facet
  for (std::size_t k = 0; k < all.size(); ++k) {
    Extent<d> &extent = out.along[k];
    const double norm = all[k].norm();
    extent.axis = norm > 0 ? Vector<d>(all[k] / norm) : Vector<d>(Vector<d>::Zero());
    extent.error = rounding * (1 + size / shortest);
    extent.low = std::numeric_limits<double>::infinity();
    extent.high = -extent.low;
    for (const Vector<d> &x : corner) {
      extent.low = std::min(extent.low, extent.axis.dot(x));
      extent.high = std::max(extent.high, extent.axis.dot(x));
    }
  }
  return out;
}

/// Whether an axis of one of them clearly separates it from the other.
template <std::size_t d>
bool is_apart(const Extents<d> &one, const Corners<d> &other, double slack,
              double reach) {
  for (const Extent<d> &extent : one.along) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vector<d> &x : other) {
      const double at = extent.axis.dot(x);
      low = std::min(low, at);
      high = std::max(high, at);
    }
    const double gap = slack + extent.error * reach;
    if (low > extent.high + gap || high < extent.low - gap)
      return true;
  }
  return false;
}

} // namespace

template <std::size_t d>
std::vector<std::array<Index, 2>> close_facets(std::span<const Vector<d>> points,
                                               std::span<const Facet<d>> facets,
                                               double contact) {
  const std::size_t n = facets.size();
  double farthest = 0;
  for (const Vector<d> &p : points)
    farthest = std::max(farthest, p.cwiseAbs().maxCoeff());
  const auto corners = [&](std::size_t k) {
    Corners<d> corner;
    for (std::size_t i = 0; i < d; ++i)
      corner[i] = points[facets[k][i]];
    return corner;
  };
  std::vector<Box<d>> boxes(n);
  std::vector<Extents<d>> along(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Corners<d> corner = corners(k);
    for (const Vector<d> &x : corner)
      boxes[k].extend(x);
    const double size = (boxes[k].high - boxes[k].low).norm();
    along[k] = extents_of<d>(corner, size);
    const Vector<d> margin =
        Vector<d>::Constant(2 * contact * size + rounding * farthest);
    boxes[k].low -= margin;
    boxes[k].high += margin;
  }

  const BoxTree<d> tree(boxes);
  std::vector<std::array<Index, 2>> pairs;
  std::vector<Index> met;
  for (std::size_t k = 0; k < n; ++k) {
    const Corners<d> corner = corners(k);
    met.clear();
    tree.meeting(boxes[k], [&](Index item) {
      const std::size_t j = item;
      if (j <= k)
        return true;
      const double reach = along[k].size + along[j].size;
      const double slack = 2 * contact * reach + rounding * farthest;
      if (!is_apart<d>(along[k], corners(j), slack, reach) &&
          !is_apart<d>(along[j], corner, slack, reach))
        met.push_back(item);
      return true;
    });
    std::sort(met.begin(), met.end());
    for (const Index j : met)
      pairs.push_back({static_cast<Index>(k), j});
  }
  return pairs;
}

template std::vector<std::array<Index, 2>>
close_facets<2>(std::span<const Vector<2>>, std::span<const Facet<2>>, double);
template std::vector<std::array<Index, 2>>
close_facets<3>(std::span<const Vector<3>>, std::span<const Facet<3>>, double);

} // namespace anistar
