#include "search/nearest_facet.h"

#include "search/box_tree.h"
#include "search/nearest_on.h"

#include <cmath>

namespace anistar {

template <std::size_t d>
std::vector<NearestFacet> nearest_facets(std::span<const Vector<d>> points,
                                         std::span<const Facet<d>> facets,
                                         std::span<const Vector<d>> queries) {
  const auto corners = [&](std::size_t f) {
    std::array<Vector<d>, d> at;
    for (std::size_t i = 0; i < d; ++i)
      at[i] = points[facets[f][i]];
    return at;
  };
  const BoxTree<d> tree(facets.size(), [&](std::size_t f) {
    Box<d> box;
    for (const Vector<d> &x : corners(f))
      box.extend(x);
    return box;
  });
  const auto squared_distance = [&](const Vector<d> &x, std::size_t f) {
    const auto simplex = corners(f);
    const auto weights = nearest_on(x, simplex);
    Vector<d> foot = Vector<d>::Zero();
    for (std::size_t i = 0; i < d; ++i)
      foot += weights[i] * simplex[i];
    return (foot - x).squaredNorm();
  };
  std::vector<NearestFacet> found;
  found.reserve(queries.size());
  for (const Vector<d> &x : queries) {
    NearestFacet best{none, std::numeric_limits<double>::infinity()};
    tree.nearest(x, best.distance, [&](Index item, double) {
      const double here = squared_distance(x, item);
      if (here < best.distance || (here == best.distance && item < best.facet))
        best = {item, here};
      return best.distance;
    });
    found.push_back({best.facet, std::sqrt(best.distance)});
  }
  return found;
}

template std::vector<NearestFacet> nearest_facets<2>(std::span<const Vector<2>>,
                                                     std::span<const Facet<2>>,
                                                     std::span<const Vector<2>>);
template std::vector<NearestFacet> nearest_facets<3>(std::span<const Vector<3>>,
                                                     std::span<const Facet<3>>,
                                                     std::span<const Vector<3>>);

} // namespace anistar
