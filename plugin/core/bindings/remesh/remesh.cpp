#include "plane/remesh.h"
#include "bindings/bind.h"
#include "bindings/remesh/report.h"
#include "bindings/remesh/settings.h"
#include "bindings/support/geometry.h"

#include <nanobind/stl/function.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

namespace anistar::bindings {
namespace {

Projection projection_of(nb::handle project) {
  if (project.is_none())
    return {};
  return [project](const Vector<2> &x, Index tag) -> Vector<2> {
    nb::gil_scoped_acquire acquire;
    const auto moved = nb::cast<std::pair<double, double>>(project(x[0], x[1], tag));
    return {moved.first, moved.second};
  };
}

nb::dict remesh2(const Array2<double> &points, const Array2<Index> &cells,
                 const Array3<double> &metric, const Array2<double> &geometry_points,
                 const Array2<Index> &geometry_cells,
                 const Array1<Index> &geometry_cell_tags,
                 const Array2<Index> &geometry_facets,
                 const Array1<Index> &geometry_facet_tags, const Array1<Index> &corners,
                 const Array1<Index> &frozen_tags, const nb::dict &shape,
                 const nb::dict &settings, const nb::object &project,
                 const nb::object &callback) {
  const auto tensors = tensors_of<2>(metric);
  const GeometryInput geometry{
      points_of<2>(geometry_points),   cells_of<2>(geometry_cells),
      indices_of(geometry_cell_tags),  facets_of<2>(geometry_facets),
      indices_of(geometry_facet_tags), indices_of(corners),
      indices_of(frozen_tags),         shape_of(shape)};
  const RemeshSettings chosen = settings_of(settings);
  const Projection projection = projection_of(project);
  RemeshResult<2> out;
  {
    nb::gil_scoped_release release;
    const Background<2> background(points_of<2>(points), cells_of<2>(cells), tensors,
                                   chosen.threads);
    out = remesh(background, geometry, projection, chosen, progress_of(callback));
  }
  return as_dict<2>(out);
}

} // namespace

void bind_remesh(nb::module_ &module) {
  static nb::handle error_type =
      PyErr_NewException("anistar._core.MeshingError", PyExc_RuntimeError, nullptr);
  module.attr("MeshingError") = error_type;
  nb::register_exception_translator([](const std::exception_ptr &thrown, void *) {
    try {
      std::rethrow_exception(thrown);
    } catch (const MeshingError &error) {
      const auto arguments =
          nb::make_tuple(error.what(), error.place()[0], error.place()[1]);
      PyErr_SetObject(error_type.ptr(), arguments.ptr());
    } catch (const std::domain_error &error) { // of what was checked: a failure of ours
      const auto arguments = nb::make_tuple(error.what());
      PyErr_SetObject(error_type.ptr(), arguments.ptr());
    }
  });
  module.def(
      "remesh2", &remesh2, nb::arg("points").noconvert(), nb::arg("cells").noconvert(),
      nb::arg("metric").noconvert(), nb::arg("geometry_points").noconvert(),
      nb::arg("geometry_cells").noconvert(), nb::arg("geometry_cell_tags").noconvert(),
      nb::arg("geometry_facets").noconvert(),
      nb::arg("geometry_facet_tags").noconvert(), nb::arg("corners").noconvert(),
      nb::arg("frozen_tags").noconvert(), nb::arg("shape"), nb::arg("settings"),
      nb::arg("project").none(), nb::arg("callback").none(),
      "A mesh of the geometry with unit edges in the metric that the mesh "
      "(points, cells) carries.");
}

} // namespace anistar::bindings
