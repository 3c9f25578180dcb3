#include "plane/geometry/facet_shapes.h"
#include "bindings/bind.h"
#include "bindings/remesh/settings.h"
#include "bindings/support/geometry.h"
#include "surface/facet_shapes.h"

#include <nanobind/stl/tuple.h>

namespace anistar::bindings {
namespace {

template <class Input> auto shapes_of(const Input &input) {
  FacetShapes shapes(0);
  {
    nb::gil_scoped_release release;
    shapes = facet_shapes(input);
  }
  const std::size_t n = shapes.sag.size(), n_edges = shapes.edge_length.size();
  return std::make_tuple(owned(std::move(shapes.measure), {n}),
                         owned(std::move(shapes.bulge), {n}),
                         owned(std::move(shapes.sag), {n}),
                         owned(std::move(shapes.edge_length), {n_edges}));
}

auto shapes2(const Array2<double> &points, const Array2<Index> &cells,
             const Array1<Index> &cell_tags, const Array2<Index> &facets,
             const Array1<Index> &facet_tags, const Array1<Index> &corners,
             const Array1<Index> &frozen_tags, const nb::dict &shape) {
  const GeometryInput input{points_of<2>(points),    cells_of<2>(cells),
                            indices_of(cell_tags),   facets_of<2>(facets),
                            indices_of(facet_tags),  indices_of(corners),
                            indices_of(frozen_tags), shape_of(shape)};
  return shapes_of(input);
}

auto shapes3(const Array2<double> &points, const Array2<Index> &facets,
             const Array1<Index> &facet_tags, const Array2<Index> &edges,
             const Array1<Index> &edge_tags, const Array1<Index> &corners,
             const Array1<Index> &frozen_tags, const nb::dict &shape) {
  const SurfaceInput input{points_of<3>(points),    facets_of<3>(facets),
                           indices_of(facet_tags),  pairs_of(edges),
                           indices_of(edge_tags),   indices_of(corners),
                           indices_of(frozen_tags), shape_of(shape)};
  return shapes_of(input);
}

} // namespace

void bind_facet_shapes(nb::module_ &module) {
  constexpr auto text =
      "Measure of the smooth shape at each facet, what it adds behind "
      "the facet, and how far it may lie from it; length of the "
      "smooth ridge at each edge.";
  module.def("facet_shapes2", &shapes2, nb::arg("points").noconvert(),
             nb::arg("cells").noconvert(), nb::arg("cell_tags").noconvert(),
             nb::arg("facets").noconvert(), nb::arg("facet_tags").noconvert(),
             nb::arg("corners").noconvert(), nb::arg("frozen_tags").noconvert(),
             nb::arg("shape"), text);
  module.def("facet_shapes3", &shapes3, nb::arg("points").noconvert(),
             nb::arg("facets").noconvert(), nb::arg("facet_tags").noconvert(),
             nb::arg("edges").noconvert(), nb::arg("edge_tags").noconvert(),
             nb::arg("corners").noconvert(), nb::arg("frozen_tags").noconvert(),
             nb::arg("shape"), text);
}

} // namespace anistar::bindings
