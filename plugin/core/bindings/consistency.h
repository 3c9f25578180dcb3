#pragma once
// The options of Algorithm 2, and what it did.

#include "../consistency_rules.h"
#include "arrays.h"

#include <nanobind/stl/string.h>

#include <stdexcept>

namespace anistar::bindings {

[[nodiscard]] inline ConsistencyMode consistency_mode(const std::string &name) {
  if (name == "off")
    return ConsistencyMode::off;
  if (name == "on")
    return ConsistencyMode::on;
  if (name == "pure")
    return ConsistencyMode::pure;
  throw std::invalid_argument("unknown consistency mode '" + name + "'");
}

[[nodiscard]] inline ConsistencyParameters parameters_of(const nb::dict &given) {
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

[[nodiscard]] inline nb::dict consistency_dict(const ConsistencyCounts &counts) {
  nb::dict out;
  out["size"] = counts.size;
  out["radius_edge"] = counts.radius_edge;
  out["sliver"] = counts.sliver;
  out["inconsistency"] = counts.inconsistency;
  out["boundary"] = counts.boundary;
  out["rounds"] = counts.rounds;
  out["ln_gamma_p90"] = counts.ln_gamma_p90;
  out["stop_reason"] = counts.stop;
  return out;
}

} // namespace anistar::bindings
