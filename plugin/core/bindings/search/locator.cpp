#include "search/locator.h"
#include "bindings/bind.h"
#include "bindings/support/geometry.h"

#include <nanobind/stl/tuple.h>

namespace anistar::bindings {
namespace {

template <std::size_t d> void bind_dimension(nb::module_ &module, const char *name) {
  using L = Locator<d>;
  nb::class_<L>(module, name, "Exact point location in a simplicial mesh.")
      .def(
          "__init__",
          [](L *self, const Array2<double> &points, const Array2<Index> &cells) {
            new (self) L(points_of<d>(points), cells_of<d>(cells));
          },
          nb::arg("points").noconvert(), nb::arg("cells").noconvert())
      .def(
          "locate",
          [](const L &self, const Array2<double> &queries) {
            const auto x = points_of<d>(queries);
            std::vector<Index> cells(x.size());
            std::vector<double> barycentric(x.size() * (d + 1)), distance(x.size());
            {
              nb::gil_scoped_release release;
              const auto found = self.locate_all(x);
              for (std::size_t k = 0; k < x.size(); ++k) {
                cells[k] = found[k].cell;
                distance[k] = found[k].distance;
                std::copy(found[k].barycentric.begin(), found[k].barycentric.end(),
                          barycentric.begin() +
                              static_cast<std::ptrdiff_t>(k * (d + 1)));
              }
            }
            return std::make_tuple(owned(std::move(cells), {x.size()}),
                                   owned(std::move(barycentric), {x.size(), d + 1}),
                                   owned(std::move(distance), {x.size()}));
          },
          nb::arg("queries").noconvert(),
          "Cell, barycentric coordinates and distance of the mesh point nearest to "
          "each "
          "query.");
}

} // namespace

void bind_locator(nb::module_ &module) {
  bind_dimension<2>(module, "Locator2");
  bind_dimension<3>(module, "Locator3");
}

} // namespace anistar::bindings
