#include "bindings/remesh/settings.h"

#include <nanobind/stl/string.h>

#include <stdexcept>

namespace anistar::bindings {
namespace {

[[nodiscard]] AgreementMode agreement_mode(const std::string &name) {
  if (name == "off")
    return AgreementMode::off;
  if (name == "auto")
    return AgreementMode::when_possible;
  if (name == "on")
    return AgreementMode::on;
  throw std::invalid_argument("unknown agreement mode '" + name + "'");
}

[[nodiscard]] ConsistencyMode consistency_mode(const std::string &name) {
  if (name == "off")
    return ConsistencyMode::off;
  if (name == "on")
    return ConsistencyMode::on;
  if (name == "pure")
    return ConsistencyMode::pure;
  throw std::invalid_argument("unknown consistency mode '" + name + "'");
}

[[nodiscard]] ConsistencyParameters parameters_of(const nb::dict &given) {
  const auto value = [&](const char *name) { return nb::cast<double>(given[name]); };
  return {value("alpha_0"),
          value("rho_0"),
          value("sigma_0"),
          value("gamma_0"),
          value("delta"),
          value("beta"),
          nb::cast<int>(given["candidates"]),
          value("max_growth")};
}

} // namespace

RemeshSettings settings_of(const nb::dict &given) {
  RemeshSettings out;
  out.hausdorff = {nb::cast<double>(given["curve_hausdorff_number"]),
                   nb::cast<double>(given["surface_hausdorff_number"])};
  out.max_vertices = nb::cast<std::size_t>(given["max_vertices"]);
  out.max_seconds = nb::cast<double>(given["max_seconds"]);
  out.agreement = agreement_mode(nb::cast<std::string>(given["agreement"]));
  out.consistency = consistency_mode(nb::cast<std::string>(given["consistency"]));
  out.parameters = parameters_of(nb::cast<nb::dict>(given["parameters"]));
  out.seed = nb::cast<std::uint64_t>(given["seed"]);
  out.threads = nb::cast<int>(given["threads"]);
  return out;
}

DomainShape shape_of(const nb::dict &given) {
  const auto kind = nb::cast<std::string>(given["kind"]);
  if (kind != "smooth" && kind != "polyhedron")
    throw std::invalid_argument("unknown kind of shape '" + kind + "'");
  return {kind == "polyhedron", nb::cast<double>(given["ridge_angle"])};
}

Monitor::Progress progress_of(nb::handle callback) {
  return [callback](const std::string &phase, double fraction) {
    nb::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0)
      throw nb::python_error();
    if (!callback.is_none())
      callback(phase, fraction);
  };
}

} // namespace anistar::bindings
