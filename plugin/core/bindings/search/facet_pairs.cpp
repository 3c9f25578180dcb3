#include "search/facet_pairs.h"
#include "bindings/bind.h"
#include "bindings/support/geometry.h"

namespace anistar::bindings {
namespace {

template <std::size_t d> void bind_dimension(nb::module_ &module, const char *name) {
  module.def(
      name,
      [](const Array2<double> &points, const Array2<Index> &facets, double contact) {
        const auto p = points_of<d>(points);
        const auto f = facets_of<d>(facets);
        for (const Facet<d> &facet : f)
          for (const Index v : facet)
            if (v < 0 || std::cmp_greater_equal(v, p.size()))
              throw std::invalid_argument("vertex " + std::to_string(v) +
                                          " is not a point");
        std::vector<std::array<Index, 2>> pairs;
        {
          nb::gil_scoped_release release;
          pairs = close_facets<d>(p, f, contact);
        }
        return rows<Index, 2>(std::move(pairs));
      },
      nb::arg("points").noconvert(), nb::arg("facets").noconvert(), nb::arg("contact"),
      "Pairs of facets without a clear gap between them, each once, (n, 2).");
}

} // namespace

void bind_facet_pairs(nb::module_ &module) {
  bind_dimension<2>(module, "close_facets2");
  bind_dimension<3>(module, "close_facets3");
}

} // namespace anistar::bindings
