#include "bindings/bind.h"
#include "remesh/remesh_settings.h"

#include <nanobind/stl/vector.h>

namespace anistar::bindings {
namespace {

void bind_domain_shape(nb::module_ &module) {
  nb::enum_<ShapeKind>(module, "ShapeKind")
      .value("smooth", ShapeKind::smooth)
      .value("polyhedron", ShapeKind::polyhedron)
      .value("faceted", ShapeKind::faceted);
  nb::class_<DomainShape>(module, "DomainShape", "What the facets of a geometry mean.")
      .def(nb::init<>())
      .def_rw("kind", &DomainShape::kind)
      .def_rw("ridge_angle", &DomainShape::ridge_angle)
      .def_rw("frozen_tags", &DomainShape::frozen_tags);
}

void bind_consistency(nb::module_ &module) {
  nb::enum_<ConsistencyMode>(module, "ConsistencyMode")
      .value("off", ConsistencyMode::off)
      .value("on", ConsistencyMode::on)
      .value("pure", ConsistencyMode::pure);
  using Parameters = ConsistencyParameters;
  nb::class_<Parameters>(module, "ConsistencyParameters", "Parameters of Algorithm 2.")
      .def(nb::init<>())
      .def_rw("alpha_0", &Parameters::alpha_0)
      .def_rw("alpha_1", &Parameters::alpha_1)
      .def_rw("rho_0", &Parameters::rho_0)
      .def_rw("sigma_0", &Parameters::sigma_0)
      .def_rw("gamma_0", &Parameters::gamma_0)
      .def_rw("delta", &Parameters::delta)
      .def_rw("beta", &Parameters::beta)
      .def_rw("candidates", &Parameters::candidates)
      .def_rw("max_growth", &Parameters::max_growth)
      .def_rw("protecting_balls", &Parameters::protecting_balls);
}

} // namespace

void bind_remesh_settings(nb::module_ &module) {
  bind_domain_shape(module);
  bind_consistency(module);
  nb::enum_<AgreementMode>(module, "AgreementMode")
      .value("off", AgreementMode::off)
      .value("when_possible", AgreementMode::when_possible)
      .value("on", AgreementMode::on);
  nb::class_<HausdorffNumbers>(module, "HausdorffNumbers",
                               "Largest distances of curves and of surfaces "
                               "from an edge, relative to its length.")
      .def(nb::init<double, double>(), nb::kw_only(), nb::arg("curve"),
           nb::arg("surface"));
  nb::class_<RemeshSettings>(module, "RemeshSettings",
                             "What a remesher is told; a bound that is not set is off.")
      .def(nb::init<>())
      .def_rw("shape", &RemeshSettings::shape)
      .def_rw("hausdorff", &RemeshSettings::hausdorff)
      .def_rw("max_vertices", &RemeshSettings::max_vertices)
      .def_rw("max_seconds", &RemeshSettings::max_seconds)
      .def_rw("agreement", &RemeshSettings::agreement)
      .def_rw("consistency", &RemeshSettings::consistency)
      .def_rw("parameters", &RemeshSettings::parameters)
      .def_rw("seed", &RemeshSettings::seed)
      .def_rw("threads", &RemeshSettings::threads);
}

} // namespace anistar::bindings
