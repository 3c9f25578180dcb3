#include "plane/geometry/facet_shapes.h"
#include "bindings/bind.h"
#include "bindings/remesh/geometry_inputs.h"
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

auto shapes(const MeshArrays &geometry, const DomainShape &shape) {
  return geometry.dimension() == 2 ? shapes_of(curves_of(geometry, shape))
                                   : shapes_of(surfaces_of(geometry, shape));
}

} // namespace

void bind_facet_shapes(nb::module_ &module) {
  module.def("facet_shapes", &shapes, nb::arg("geometry"), nb::arg("shape"),
             "Measure of the smooth shape at each facet, what it adds behind "
             "the facet, "
             "and how far it may lie from it; length of the smooth ridge at "
             "each edge.");
}

} // namespace anistar::bindings
