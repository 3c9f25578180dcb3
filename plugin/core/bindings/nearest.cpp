#include "search/nearest.h"
#include "bind.h"
#include "geometry.h"

namespace anistar::bindings {
namespace {

template <std::size_t d> void bind_dimension(nb::module_ &module, const char *name) {
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
          if (seed < 0 || static_cast<std::size_t>(seed) >= p.size())
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
  bind_dimension<2>(module, "nearest_in_metric2");
  bind_dimension<3>(module, "nearest_in_metric3");
}

} // namespace anistar::bindings
