#include "bindings/support/mesh_arrays.h"
#include "bindings/bind.h"

#include <nanobind/stl/string.h>

#include <type_traits>

namespace anistar::bindings {
namespace {

std::string text_of(const nb::object &value) {
  return nb::cast<std::string>(nb::str(value));
}

/// The array given under a name, as it is.
template <class Array> Array array_of(const char *name, nb::handle given) {
  using Config = typename Array::Config;
  Array array;
  if (nb::try_cast(given, array, /*convert=*/false))
    return array;
  const std::string dtype =
      std::is_same_v<typename Config::Scalar, const double> ? "float64" : "int32";
  std::string found = text_of(given.type().attr("__name__"));
  if (nb::hasattr(given, "dtype") && nb::hasattr(given, "shape"))
    found = text_of(given.attr("dtype")) + " of shape " + text_of(given.attr("shape"));
  throw nb::type_error((std::string(name) + " must be a contiguous array of " + dtype +
                        " with " + std::to_string(Config::N) + " axes, got " + found)
                           .c_str());
}

void check_columns(const char *name, const Array2<Index> &array, std::size_t expected) {
  if (array.shape(1) != expected)
    throw std::invalid_argument(std::string(name) + " must have " +
                                std::to_string(expected) + " columns, got " +
                                std::to_string(array.shape(1)));
}

void check_tags(const char *name, const Array1<Index> &tags,
                const Array2<Index> &tagged) {
  if (tags.shape(0) != tagged.shape(0))
    throw std::invalid_argument(std::string(name) + " must have " +
                                std::to_string(tagged.shape(0)) + " rows, got " +
                                std::to_string(tags.shape(0)));
}

void check(const MeshArrays &mesh) {
  const std::size_t d = mesh.points.shape(1);
  if (d != 2 && d != 3)
    throw std::invalid_argument("points must have 2 or 3 columns, got " +
                                std::to_string(d));
  check_columns("cells", mesh.cells, d + 1);
  check_columns("facets", mesh.facets, d);
  check_columns("edges", mesh.edges, 2);
  check_tags("cell_tags", mesh.cell_tags, mesh.cells);
  check_tags("facet_tags", mesh.facet_tags, mesh.facets);
  check_tags("edge_tags", mesh.edge_tags, mesh.edges);
}

void construct(MeshArrays *self, nb::handle points, nb::handle cells,
               nb::handle cell_tags, nb::handle facets, nb::handle facet_tags,
               nb::handle edges, nb::handle edge_tags, nb::handle corners) {
  const MeshArrays mesh{
      .points = array_of<Array2<double>>("points", points),
      .cells = array_of<Array2<Index>>("cells", cells),
      .cell_tags = array_of<Array1<Index>>("cell_tags", cell_tags),
      .facets = array_of<Array2<Index>>("facets", facets),
      .facet_tags = array_of<Array1<Index>>("facet_tags", facet_tags),
      .edges = array_of<Array2<Index>>("edges", edges),
      .edge_tags = array_of<Array1<Index>>("edge_tags", edge_tags),
      .corners = array_of<Array1<Index>>("corners", corners),
  };
  check(mesh);
  new (self) MeshArrays(mesh);
}

} // namespace

void bind_mesh_arrays(nb::module_ &module) {
  // an array read back is the one that was given
  nb::class_<MeshArrays>(module, "MeshArrays",
                         "A mesh as arrays, which are not copied.")
      .def("__init__", &construct, nb::kw_only(), nb::arg("points"), nb::arg("cells"),
           nb::arg("cell_tags"), nb::arg("facets"), nb::arg("facet_tags"),
           nb::arg("edges"), nb::arg("edge_tags"), nb::arg("corners"),
           nb::sig("def __init__(self, *, points: NDArray[numpy.float64], "
                   "cells: NDArray[numpy.int32], cell_tags: NDArray[numpy.int32], "
                   "facets: NDArray[numpy.int32], facet_tags: NDArray[numpy.int32], "
                   "edges: NDArray[numpy.int32], edge_tags: NDArray[numpy.int32], "
                   "corners: NDArray[numpy.int32]) -> None"))
      .def_ro("points", &MeshArrays::points, nb::rv_policy::automatic)
      .def_ro("cells", &MeshArrays::cells, nb::rv_policy::automatic)
      .def_ro("cell_tags", &MeshArrays::cell_tags, nb::rv_policy::automatic)
      .def_ro("facets", &MeshArrays::facets, nb::rv_policy::automatic)
      .def_ro("facet_tags", &MeshArrays::facet_tags, nb::rv_policy::automatic)
      .def_ro("edges", &MeshArrays::edges, nb::rv_policy::automatic)
      .def_ro("edge_tags", &MeshArrays::edge_tags, nb::rv_policy::automatic)
      .def_ro("corners", &MeshArrays::corners, nb::rv_policy::automatic);
}

} // namespace anistar::bindings
