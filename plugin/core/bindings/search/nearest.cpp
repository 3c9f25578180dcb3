#include "search/nearest.h"
#include "bindings/bind.h"
#include "bindings/support/geometry.h"
#include "search/nearest_facet.h"

#include <nanobind/stl/pair.h>

namespace anistar::bindings {
namespace {

template <std::size_t d>
auto nearest_facets_of(const Array2<double> &points, const Array2<Index> &facets,
                       const Array2<double> &queries) {
  const auto p = points_of<d>(points);
  const auto f = facets_of<d>(facets);
  const auto q = points_of<d>(queries);
  if (f.empty())
    throw std::invalid_argument("there are no facets");
  std::vector<NearestFacet> found;
  {
    nb::gil_scoped_release release;
    found = nearest_facets<d>(p, f, q);
  }
  std::vector<Index> rows(found.size());
  std::vector<double> distances(found.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    rows[k] = found[k].facet;
    distances[k] = found[k].distance;
  }
  return std::make_pair(owned(std::move(rows), {found.size()}),
                        owned(std::move(distances), {found.size()}));
}

template <std::size_t d>
void bind_dimension(nb::module_ &module, const char *name, const char *facets_name) {
  module.def(facets_name, &nearest_facets_of<d>, nb::arg("points").noconvert(),
             nb::arg("facets").noconvert(), nb::arg("queries").noconvert(),
             "The row of the facet nearest to each query, and its distance.");
  module.def(
      name,
      [](const Array2<double> &points, const Array2<double> &queries,
         const Array3<double> &metrics, const Array1<Index> &seeds) {
        const auto p = points_of<d>(points);
        const auto q = points_of<d>(queries);
        const auto M = tensors_of<d>(metrics);
        const auto s = indices_of(seeds);
        if (M.size() != q.size() || s.size() != q.size())
          throw std::invalid_argument("every query needs a metric and a seed");
        for (const Index seed : s)
          if (seed < 0 || std::cmp_greater_equal(seed, p.size()))
            throw std::invalid_argument("seed " + std::to_string(seed) +
                                        " is not a point");
        std::vector<Index> nearest;
        {
          nb::gil_scoped_release release;
          nearest = nearest_in_metric<d>(p, q, M, s);
        }
        const std::size_t n = nearest.size();
        return owned(std::move(nearest), {n});
      },
      nb::arg("points").noconvert(), nb::arg("queries").noconvert(),
      nb::arg("metrics").noconvert(), nb::arg("seeds").noconvert(),
      "The point nearest to each query in the query's own metric.");
}

} // namespace

void bind_nearest(nb::module_ &module) {
  bind_dimension<2>(module, "nearest_in_metric2", "nearest_facets2");
  bind_dimension<3>(module, "nearest_in_metric3", "nearest_facets3");
}

} // namespace anistar::bindings
