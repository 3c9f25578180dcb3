#include "../remesh.h"
#include "bind.h"
#include "consistency.h"
#include "geometry.h"
#include "report.h"

#include <nanobind/stl/function.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

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
                 const Array1<Index> &frozen_tags, double ridge_angle,
                 double hausdorff_number, std::size_t max_vertices, double max_seconds,
                 const std::string &agreement, const std::string &consistency,
                 const nb::dict &parameters, std::uint64_t seed, int threads,
                 const nb::object &project, const nb::object &callback) {
  const auto tensors = tensors_of<2>(metric);
  const GeometryInput geometry{
      points_of<2>(geometry_points),   cells_of<2>(geometry_cells),
      indices_of(geometry_cell_tags),  facets_of<2>(geometry_facets),
      indices_of(geometry_facet_tags), indices_of(corners),
      indices_of(frozen_tags),         ridge_angle};
  RemeshSettings settings;
  settings.hausdorff_number = hausdorff_number;
  settings.max_vertices = max_vertices;
  settings.max_seconds = max_seconds;
  settings.agreement = agreement_mode(agreement);
  settings.consistency = consistency_mode(consistency);
  settings.parameters = parameters_of(parameters);
  settings.seed = seed;
  settings.threads = threads;
  const Projection projection = projection_of(project);
  RemeshResult out;
  {
    nb::gil_scoped_release release;
    const Background<2> background(points_of<2>(points), cells_of<2>(cells), tensors,
                                   threads);
    out = remesh(background, geometry, projection, settings, progress_of(callback));
  }
  nb::dict result;
  put_vertices<2>(result, out.vertices);
  result["cells"] = rows<Index, 3>(out.cells);
  result["cell_tags"] = owned(std::move(out.cell_tags), {out.cells.size()});
  result["facets"] = rows<Index, 2>(out.facets);
  result["facet_tags"] = owned(std::move(out.facet_tags), {out.facets.size()});
  put_certified(result, out.was_checked, out.simplex_ok, out.star_ok);
  result["agreement"] = out.agreement;
  result["consistency"] = consistency_dict(out.consistency);
  result["distortion"] = as_dict(out.distortion);
  result["statistics"] = as_dict(out.statistics);
  result["counts"] = out.counts;
  result["seconds"] = out.seconds;
  result["stop_reason"] = name_of(out.reason);
  return result;
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
    }
  });
  module.def(
      "remesh2", &remesh2, nb::arg("points").noconvert(), nb::arg("cells").noconvert(),
      nb::arg("metric").noconvert(), nb::arg("geometry_points").noconvert(),
      nb::arg("geometry_cells").noconvert(), nb::arg("geometry_cell_tags").noconvert(),
      nb::arg("geometry_facets").noconvert(),
      nb::arg("geometry_facet_tags").noconvert(), nb::arg("corners").noconvert(),
      nb::arg("frozen_tags").noconvert(), nb::arg("ridge_angle"),
      nb::arg("hausdorff_number"), nb::arg("max_vertices"), nb::arg("max_seconds"),
      nb::arg("agreement"), nb::arg("consistency"), nb::arg("parameters"),
      nb::arg("seed"), nb::arg("threads"), nb::arg("project").none(),
      nb::arg("callback").none(),
      "A mesh of the geometry with unit edges in the metric that the mesh "
      "(points, cells) carries.");
}

} // namespace anistar::bindings
