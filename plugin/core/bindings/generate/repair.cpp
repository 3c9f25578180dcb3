#include "bindings/bind.h"
#include "bindings/support/geometry.h"
#include "bindings/support/interrupt.h"
#include "generate/repair/arrangement.h"
#include "generate/repair/orientation.h"
#include "generate/repair/wrap.h"

#include <nanobind/stl/tuple.h>

#include <limits>

namespace anistar::bindings {
namespace {

struct Triangles {
  std::span<const Vector<3>> points;
  std::span<const Facet<3>> rows;

  Triangles(const Array2<double> &p, const Array2<Index> &t)
      : points(points_of<3>(p)), rows(facets_of<3>(t)) {
    for (const Facet<3> &row : rows)
      for (const Index v : row)
        if (v < 0 || std::cmp_greater_equal(v, points.size()))
          throw std::invalid_argument("vertex " + std::to_string(v) +
                                      " is not a point");
  }
};

Monitor watching_signals() {
  return {[](const std::string &, double, std::size_t) { look_for_signals(); },
          std::numeric_limits<std::size_t>::max(),
          std::numeric_limits<double>::infinity()};
}

auto arrays_of(generate::TriangleSoup soup) {
  const std::size_t n = soup.sources.size();
  return std::make_tuple(rows<double, 3>(std::move(soup.points)),
                         rows<Index, 3>(std::move(soup.triangles)),
                         owned(std::move(soup.sources), {n}));
}

} // namespace

void bind_repair(nb::module_ &module) {
  module.def(
      "cut_triangles",
      [](const Array2<double> &points, const Array2<Index> &triangles) {
        const Triangles given(points, triangles);
        generate::TriangleSoup soup;
        {
          nb::gil_scoped_release release;
          Monitor monitor = watching_signals();
          soup = generate::arrangement_of(given.points, given.rows, monitor);
        }
        return arrays_of(std::move(soup));
      },
      nb::arg("points").noconvert(), nb::arg("triangles").noconvert(),
      "Points, triangles and the source of each, cut where triangles meet others.");
  module.def(
      "turned_triangles",
      [](const Array2<double> &points, const Array2<Index> &triangles) {
        const Triangles given(points, triangles);
        const auto turned = generate::turned_triangles(given.points, given.rows);
        std::vector<std::uint8_t> is_turned(turned.is_turned.begin(),
                                            turned.is_turned.end());
        const std::size_t n = is_turned.size();
        return std::make_tuple(owned(std::move(is_turned), {n}), turned.n_open,
                               turned.n_one_sided);
      },
      nb::arg("points").noconvert(), nb::arg("triangles").noconvert(),
      "Which triangles to turn for an outer side, and the numbers of parts that are "
      "open "
      "and that have one side only.");
  module.def(
      "wrap_triangles",
      [](const Array2<double> &points, const Array2<Index> &triangles, double alpha,
         double offset) {
        const Triangles given(points, triangles);
        generate::TriangleSoup soup;
        {
          nb::gil_scoped_release release;
          soup = generate::wrapped(given.points, given.rows, {alpha, offset});
        }
        return arrays_of(std::move(soup));
      },
      nb::arg("points").noconvert(), nb::arg("triangles").noconvert(), nb::arg("alpha"),
      nb::arg("offset"), "A closed surface around triangles.");
}

} // namespace anistar::bindings
