#include "report.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <span>

namespace anistar::bindings {

nb::dict as_dict(const Statistics &statistics) {
  const std::span bins(Statistics::length_bins);
  nb::dict out;
  out["edges"] = statistics.n_edges;
  out["edge_unit"] = statistics.unit_fraction;
  out["edge_min"] = statistics.length_min;
  out["edge_mean"] = statistics.length_mean;
  out["edge_max"] = statistics.length_max;
  out["edge_bins"] = std::vector<double>(bins.begin(), bins.end());
  out["edge_histogram"] = statistics.length_histogram;
  out["q_min"] = statistics.quality_min;
  out["q_mean"] = statistics.quality_mean;
  out["q_histogram"] = statistics.quality_histogram;
  return out;
}

nb::dict as_dict(const DistortionQuantiles &quantiles) {
  nb::dict out;
  out["p50"] = quantiles.p50;
  out["p90"] = quantiles.p90;
  out["p99"] = quantiles.p99;
  out["max"] = quantiles.maximum;
  return out;
}

AgreementMode agreement_mode(const std::string &name) {
  if (name == "off")
    return AgreementMode::off;
  if (name == "auto")
    return AgreementMode::when_possible;
  if (name == "on")
    return AgreementMode::on;
  throw std::invalid_argument("unknown agreement mode '" + name + "'");
}

void put_certified(nb::dict &result, bool was_checked, double simplex_ok,
                   double star_ok) {
  result["simplex_ok"] = was_checked ? nb::object(nb::float_(simplex_ok)) : nb::none();
  result["star_ok"] = was_checked ? nb::object(nb::float_(star_ok)) : nb::none();
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
