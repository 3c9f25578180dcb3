#include "bindings/bind.h"
#include "bindings/remesh/geometry_inputs.h"
#include "surface/smooth_surface.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

namespace anistar::bindings {
namespace {

/// Feet and normals, row by row.
[[nodiscard]] auto feet_of(const CurvedPieces &pieces, const Array2<double> &queries) {
  const auto x = points_of<3>(queries);
  std::vector<Vector<3>> feet(x.size()), normals(x.size());
  {
    nb::gil_scoped_release release;
    for (std::size_t k = 0; k < x.size(); ++k) {
      const CurvedPieces::Foot foot = pieces.project(x[k]);
      feet[k] = foot.x;
      normals[k] = foot.normal.normalized();
    }
  }
  return std::make_tuple(rows<double, 3>(std::move(feet)),
                         rows<double, 3>(std::move(normals)));
}

[[nodiscard]] auto curvatures(const SmoothSurface &surface, std::size_t n_points) {
  std::vector<Matrix<3>> out(n_points, Matrix<3>::Zero());
  const Jets &jets = surface.jets();
  for (std::size_t k = 0; k < jets.jets.size(); ++k) {
    Matrix<3> &here = out[jets.vertex[k]];
    const Matrix<3> found = as_matrix<3>(jets.jets[k].curvature);
    if (found.norm() > here.norm())
      here = found;
  }
  const double *data = out.front().data();
  return owned(std::vector<double>(data, data + 9 * n_points), {n_points, 3, 3});
}

} // namespace

void bind_surface(nb::module_ &module) {
  nb::class_<SmoothSurface>(module, "Surface3",
                            "The smooth surfaces and ridges through given facets.")
      .def(
          "__init__",
          [](SmoothSurface *self, const MeshArrays &geometry,
             const DomainShape &shape) {
            if (geometry.dimension() != 3)
              throw std::invalid_argument("surfaces are those of a 3D mesh");
            new (self) SmoothSurface(surfaces_of(geometry, shape));
          },
          nb::arg("geometry"), nb::arg("shape"))
      .def(
          "project",
          [](const SmoothSurface &self, const Array2<double> &queries, Index tag) {
            const CurvedPieces *pieces = self.surface(tag);
            if (!pieces)
              throw std::invalid_argument("no facet has tag " + std::to_string(tag));
            return feet_of(*pieces, queries);
          },
          nb::arg("queries").noconvert(), nb::arg("tag"),
          "Feet of points on the surfaces with a tag, and unit normals there.")
      .def(
          "project_on_ridge",
          [](const SmoothSurface &self, const Array2<double> &queries,
             std::optional<Index> tag) {
            const CurvedPieces *pieces = self.ridge(tag.has_value(), tag.value_or(0));
            if (!pieces)
              throw std::invalid_argument("there is no such ridge");
            return std::get<0>(feet_of(*pieces, queries));
          },
          nb::arg("queries").noconvert(), nb::arg("tag").none(),
          "Feet of points on the ridges with a tag; None: those without one.")
      .def(
          "ridges",
          [](const SmoothSurface &self) {
            std::vector<std::array<Index, 2>> edges;
            for (const RidgeSegment &ridge : self.segments())
              edges.push_back(ridge.ends);
            return rows<Index, 2>(std::move(edges));
          },
          "The edges that are ridges, (k, 2).")
      .def(
          "curvature",
          [](const SmoothSurface &self, std::size_t n_points) {
            return curvatures(self, n_points);
          },
          nb::arg("n_points"),
          "The (n, 3, 3) curvature tensors at the points: principal curvatures "
          "with "
          "their directions, of the most curved patch; zero off the surfaces.");
}

} // namespace anistar::bindings
