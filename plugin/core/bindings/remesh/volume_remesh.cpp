#include "bindings/bind.h"
#include "bindings/remesh/report.h"
#include "bindings/remesh/settings.h"
#include "bindings/support/geometry.h"
#include "volume/remesh.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

namespace anistar::bindings {
namespace {

[[nodiscard]] SurfaceProjection surface_projection_of(nb::handle project) {
  if (project.is_none())
    return {};
  return [project](const Vector<3> &x, Index tag) -> Vector<3> {
    nb::gil_scoped_acquire acquire;
    const auto [a, b, c] =
        nb::cast<std::tuple<double, double, double>>(project(x[0], x[1], x[2], tag));
    return {a, b, c};
  };
}

nb::dict remesh3(const Array2<double> &points, const Array2<Index> &cells,
                 const Array1<Index> &cell_tags, const Array2<Index> &facets,
                 const Array1<Index> &facet_tags, const Array2<Index> &edges,
                 const Array1<Index> &edge_tags, const Array1<Index> &corners,
                 const Array3<double> &metric, const Array2<double> &geometry_points,
                 const Array2<Index> &geometry_facets,
                 const Array1<Index> &geometry_facet_tags,
                 const Array2<Index> &geometry_edges,
                 const Array1<Index> &geometry_edge_tags,
                 const Array1<Index> &frozen_tags, const nb::dict &shape,
                 const nb::dict &settings, const nb::object &project,
                 const nb::object &callback) {
  const auto tensors = tensors_of<3>(metric);
  const VolumeInput input{cells_of<3>(cells),
                          indices_of(cell_tags),
                          {points_of<3>(points), facets_of<3>(facets),
                           indices_of(facet_tags), pairs_of(edges),
                           indices_of(edge_tags), indices_of(corners),
                           indices_of(frozen_tags), shape_of(shape)}};
  const SurfaceInput geometry{
      points_of<3>(geometry_points),   facets_of<3>(geometry_facets),
      indices_of(geometry_facet_tags), pairs_of(geometry_edges),
      indices_of(geometry_edge_tags),  {},
      indices_of(frozen_tags),         shape_of(shape)};
  const RemeshSettings chosen = settings_of(settings);
  const SurfaceProjection projection = surface_projection_of(project);
  VolumeResult out;
  {
    nb::gil_scoped_release release;
    out = remesh_volume(input, tensors, geometry, projection, chosen,
                        progress_of(callback));
  }
  nb::dict result = as_dict<3>(out);
  result["edges"] = rows<Index, 2>(out.edges);
  result["edge_tags"] = owned(std::move(out.edge_tags), {out.edges.size()});
  return result;
}

} // namespace

void bind_volume_remesh(nb::module_ &module) {
  module.def(
      "remesh3", &remesh3, nb::arg("points").noconvert(), nb::arg("cells").noconvert(),
      nb::arg("cell_tags").noconvert(), nb::arg("facets").noconvert(),
      nb::arg("facet_tags").noconvert(), nb::arg("edges").noconvert(),
      nb::arg("edge_tags").noconvert(), nb::arg("corners").noconvert(),
      nb::arg("metric").noconvert(), nb::arg("geometry_points").noconvert(),
      nb::arg("geometry_facets").noconvert(),
      nb::arg("geometry_facet_tags").noconvert(), nb::arg("geometry_edges").noconvert(),
      nb::arg("geometry_edge_tags").noconvert(), nb::arg("frozen_tags").noconvert(),
      nb::arg("shape"), nb::arg("settings"), nb::arg("project").none(),
      nb::arg("callback").none(),
      "A tetrahedral mesh with unit edges in the metric given at its points.");
}

} // namespace anistar::bindings
