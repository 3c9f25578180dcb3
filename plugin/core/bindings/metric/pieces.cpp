#include "metric/pieces.h"
#include "bindings/bind.h"
#include "bindings/support/geometry.h"

#include <nanobind/stl/pair.h>

namespace anistar::bindings {
namespace {

template <std::size_t d>
auto pieces_of(const Array2<double> &points, const Array2<Index> &cells,
               const Array3<double> &metric) {
  const auto tensors = tensors_of<d>(metric);
  const auto p = points_of<d>(points);
  const auto c = cells_of<d>(cells);
  const std::size_t n = p.size();
  if (tensors.size() != n)
    throw std::invalid_argument("a metric is needed for every point");
  for (const Cell<d> &cell : c)
    for (const Index v : cell)
      if (v < 0 || std::cmp_greater_equal(v, n))
        throw std::invalid_argument("cells have point " + std::to_string(v) +
                                    ", which there is not");
  Pieces found;
  {
    nb::gil_scoped_release release;
    found = pieces_at<d>(p, c, tensors);
  }
  return std::make_pair(owned(std::move(found.most), {n}),
                        owned(std::move(found.fewest), {n}));
}

auto pieces(const Array2<double> &points, const Array2<Index> &cells,
            const Array3<double> &metric) {
  return points.shape(1) == 2 ? pieces_of<2>(points, cells, metric)
                              : pieces_of<3>(points, cells, metric);
}

} // namespace

void bind_pieces(nb::module_ &module) {
  module.def(
      "pieces", &pieces, nb::arg("points").noconvert(), nb::arg("cells").noconvert(),
      nb::arg("metric").noconvert(),
      "Into how many pieces a metric divides the longest edge of each point, and "
      "the fewest among its neighbours.");
}

} // namespace anistar::bindings
