#include "bindings/bind.h"
#include "bindings/remesh/geometry_inputs.h"
#include "bindings/remesh/result.h"
#include "bindings/support/interrupt.h"

#include <nanobind/stl/array.h>

#include <utility>

namespace anistar::bindings {
namespace {

/// The user's function of d coordinates and a tag, which returns d coordinates.
template <std::size_t d>
std::function<Vector<d>(const Vector<d> &, Index)> projection_of(nb::handle project) {
  if (project.is_none())
    return {};
  return [project](const Vector<d> &x, Index tag) -> Vector<d> {
    nb::gil_scoped_acquire acquire;
    const auto call = [&]<std::size_t... i>(std::index_sequence<i...>) {
      return project(x[i]..., tag);
    };
    const auto moved =
        nb::cast<std::array<double, d>>(call(std::make_index_sequence<d>()));
    return Eigen::Map<const Vector<d>>(moved.data());
  };
}

/// The functions that Python may give; None: there is none.
struct Callbacks {
  nb::handle project, progress;
};

ResultArrays remeshed_plane(const MeshArrays &mesh, const Array3<double> &metric,
                            const MeshArrays &geometry, const RemeshSettings &settings,
                            const Callbacks &callbacks) {
  const auto tensors = tensors_of<2>(metric);
  const GeometryInput input = curves_of(geometry, settings.shape);
  PlaneResult out;
  {
    nb::gil_scoped_release release;
    const Background<2> background(points_of<2>(mesh.points), cells_of<2>(mesh.cells),
                                   tensors, settings.threads);
    out = remesh(background, input, projection_of<2>(callbacks.project), settings,
                 progress_of(callbacks.progress));
  }
  return ResultArrays(std::move(out));
}

ResultArrays remeshed_volume(const MeshArrays &mesh, const Array3<double> &metric,
                             const MeshArrays &geometry, const RemeshSettings &settings,
                             const Callbacks &callbacks) {
  const auto tensors = tensors_of<3>(metric);
  const VolumeInput input{cells_of<3>(mesh.cells), indices_of(mesh.cell_tags),
                          surfaces_of(mesh, settings.shape)};
  SurfaceInput surfaces = surfaces_of(geometry, settings.shape);
  surfaces.corners = {}; // those of the mesh stay
  VolumeResult out;
  {
    nb::gil_scoped_release release;
    out = remesh_volume(input, tensors, surfaces, projection_of<3>(callbacks.project),
                        settings, progress_of(callbacks.progress));
  }
  return ResultArrays(std::move(out));
}

ResultArrays remesh_arrays(const MeshArrays &mesh, const Array3<double> &metric,
                           const MeshArrays &geometry, const RemeshSettings &settings,
                           const nb::object &project, const nb::object &callback) {
  const std::size_t d = mesh.dimension();
  if (geometry.dimension() != d)
    throw std::invalid_argument("mesh and geometry differ in dimension");
  if (metric.shape(0) != mesh.points.shape(0))
    throw std::invalid_argument("metric must have a tensor for every point");
  const Callbacks callbacks{project, callback};
  return d == 2 ? remeshed_plane(mesh, metric, geometry, settings, callbacks)
                : remeshed_volume(mesh, metric, geometry, settings, callbacks);
}

} // namespace

void bind_remesh(nb::module_ &module) {
  module.def("remesh", &remesh_arrays, nb::kw_only(), nb::arg("mesh"),
             nb::arg("metric").noconvert(), nb::arg("geometry"), nb::arg("settings"),
             nb::arg("project").none(), nb::arg("callback").none(),
             "A mesh of the geometry with unit edges in the metric that the mesh "
             "carries.");
}

} // namespace anistar::bindings
