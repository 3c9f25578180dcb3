#include "bindings/remesh/result.h"
#include "bindings/bind.h"

#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <span>

namespace anistar::bindings {
namespace {

template <std::size_t d> auto places_of(const std::vector<Vertex<d>> &vertices) {
  std::vector<double> points;
  points.reserve(vertices.size() * d);
  for (const Vertex<d> &v : vertices)
    points.insert(points.end(), v.x.data(), v.x.data() + d);
  return owned(std::move(points), {vertices.size(), d});
}

/// Full tensors.
template <std::size_t d> auto metric_of(const std::vector<Vertex<d>> &vertices) {
  std::vector<double> metric;
  metric.reserve(vertices.size() * d * d);
  for (const Vertex<d> &v : vertices)
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t j = 0; j < d; ++j)
        metric.push_back(v.M(i, j));
  return owned(std::move(metric), {vertices.size(), d, d});
}

std::optional<nb::ndarray<nb::numpy, std::uint8_t>>
bits_of(std::vector<std::uint8_t> &&delaunay) {
  if (delaunay.empty())
    return {};
  const std::size_t n = delaunay.size();
  return owned(std::move(delaunay), {n});
}

Array1<Index> tags_of(std::vector<Index> &&tags) {
  const std::size_t n = tags.size();
  return held<Array1<Index>>(owned(std::move(tags), {n}));
}

template <std::size_t d>
MeshArrays arrays_of(RemeshResult<d> &&result,
                     std::vector<std::array<Index, 2>> &&edges,
                     std::vector<Index> &&edge_tags) {
  return {
      .points = held<Array2<double>>(places_of<d>(result.vertices)),
      .cells = held<Array2<Index>>(rows<Index, d + 1>(std::move(result.cells))),
      .cell_tags = tags_of(std::move(result.cell_tags)),
      .facets = held<Array2<Index>>(rows<Index, d>(std::move(result.facets))),
      .facet_tags = tags_of(std::move(result.facet_tags)),
      .edges = held<Array2<Index>>(rows<Index, 2>(std::move(edges))),
      .edge_tags = tags_of(std::move(edge_tags)),
      .corners = tags_of({}),
  };
}

using Counts = std::map<std::string, std::size_t>;

/// Of the phases that both dimensions have, where they ran.
void put_phases(const RemeshRecord &record, Counts &out) {
  if (record.agreement.was_tried()) {
    const AgreementCounts &agreed = record.agreement.counts;
    out.insert({{"disagreeing_before", agreed.before},
                {"disagreeing_after", agreed.after},
                {"trials", agreed.trials},
                {"relocations", agreed.moves}});
  }
  if (record.stars.certified)
    out.insert(
        {{"star_failures", record.stars.failures}, {"star_moves", record.stars.moves}});
}

Counts counts_of(const PlaneResult &result) {
  Counts out{{"protected_corners", result.protected_corners},
             {"unprotected_corners", result.unprotected_corners},
             {"inserted", result.refinement.inserted},
             {"boundary_splits", result.refinement.boundary_splits},
             {"rejected", result.refinement.rejected},
             {"flips", result.flips},
             {"capped", result.capped}};
  if (const auto &shape = result.shape)
    out.insert({{"splits", shape->lengths.splits},
                {"collapses", shape->lengths.collapses},
                {"poor", shape->poor},
                {"bisections", shape->bisections}});
  put_phases(result, out);
  return out;
}

Counts counts_of(const VolumeResult &result) {
  Counts out{{"curved", result.is_curved},
             {"splits", result.passes.splits},
             {"collapses", result.passes.collapses},
             {"edge_swaps", result.passes.edge_swaps},
             {"face_swaps", result.passes.face_swaps},
             {"moves", result.passes.moves},
             {"insertions", result.passes.insertions},
             {"repairs", result.passes.repairs}};
  if (result.agreement.was_tried()) {
    const AgreementCounts &agreed = result.agreement.counts;
    out.insert({{"agreement_swaps", agreed.swaps},
                {"agreement_insertions", agreed.reinsertions},
                {"agreement_repairs", agreed.repairs},
                {"polishes", agreed.polishes},
                {"agreement_rounds", static_cast<std::size_t>(agreed.rounds)}});
  }
  if (result.consistency.stop != ConsistencyStop::none_yet)
    out.emplace("consistency_moves", result.consistency.moves);
  if (result.n_sites)
    out.emplace("star_set_sites", *result.n_sites);
  put_phases(result, out);
  return out;
}

nb::typed<nb::dict, nb::str, nb::any> as_dict(const Statistics &statistics) {
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

nb::typed<nb::dict, nb::str, nb::float_> as_dict(const DistortionQuantiles &quantiles) {
  nb::dict out;
  out["p50"] = quantiles.p50;
  out["p90"] = quantiles.p90;
  out["p99"] = quantiles.p99;
  out["max"] = quantiles.maximum;
  return out;
}

/// By rule.
nb::typed<nb::dict, nb::str, nb::float_> as_dict(const ConsistencyCounts &counts) {
  nb::dict out;
  out["size"] = counts.size;
  out["radius_edge"] = counts.radius_edge;
  out["sliver"] = counts.sliver;
  out["inconsistency"] = counts.inconsistency;
  out["facet_size"] = counts.facet_size;
  out["facet_topology"] = counts.facet_topology;
  out["facet_radius_edge"] = counts.facet_radius_edge;
  out["facet_inconsistency"] = counts.facet_inconsistency;
  out["boundary"] = counts.boundary;
  out["rounds"] = counts.rounds;
  out["ln_gamma_p90"] = counts.ln_gamma_p90;
  return out;
}

void bind_agreement(nb::module_ &module) {
  nb::enum_<AgreementOutcome>(module, "AgreementOutcome")
      .value("off", AgreementOutcome::off)
      .value("stopped_before", AgreementOutcome::stopped_before)
      .value("varies_too_fast", AgreementOutcome::varies_too_fast)
      .value("stopped", AgreementOutcome::stopped)
      .value("done", AgreementOutcome::done);
  nb::enum_<AgreementStop>(module, "AgreementStop")
      .value("agreed", AgreementStop::agreed)
      .value("stalled", AgreementStop::stalled)
      .value("rounds", AgreementStop::rounds)
      .value("trials", AgreementStop::trials)
      .value("interrupted", AgreementStop::interrupted);
  nb::class_<AgreementReport>(module, "AgreementReport", "What became of agreement.")
      .def_ro("outcome", &AgreementReport::outcome)
      .def_ro("stopped_by", &AgreementReport::stopped_by)
      .def_ro("percent", &AgreementReport::percent)
      .def_ro("ln_gamma", &AgreementReport::ln_gamma)
      .def_ro("largest_ln_gamma", &AgreementReport::largest_ln_gamma)
      .def_prop_ro("stop", [](const AgreementReport &self) { return self.counts.stop; })
      .def_prop_ro("disagreeing",
                   [](const AgreementReport &self) { return self.counts.after; });
}

void bind_stop_reasons(nb::module_ &module) {
  nb::enum_<StopReason>(module, "StopReason")
      .value("finished", StopReason::finished)
      .value("max_vertices", StopReason::max_vertices)
      .value("max_seconds", StopReason::max_seconds);
  nb::enum_<ConsistencyStop>(module, "ConsistencyStop")
      .value("none_yet", ConsistencyStop::none_yet)
      .value("consistent", ConsistencyStop::consistent)
      .value("stalled", ConsistencyStop::stalled)
      .value("no_mesh", ConsistencyStop::no_mesh)
      .value("max_growth", ConsistencyStop::max_growth)
      .value("max_rounds", ConsistencyStop::max_rounds)
      .value("max_vertices", ConsistencyStop::max_vertices)
      .value("max_seconds", ConsistencyStop::max_seconds);
}

} // namespace

ResultArrays::ResultArrays(PlaneResult &&result)
    : RemeshRecord(result), metric(metric_of<2>(result.vertices)),
      counts(counts_of(result)), delaunay(bits_of(std::move(result.delaunay))),
      mesh(arrays_of<2>(std::move(result), {}, {})) {}

ResultArrays::ResultArrays(VolumeResult &&result)
    : RemeshRecord(result), metric(metric_of<3>(result.vertices)),
      counts(counts_of(result)), delaunay(bits_of(std::move(result.delaunay))),
      mesh(arrays_of<3>(std::move(result), std::move(result.edges),
                        std::move(result.edge_tags))) {}

void bind_remesh_result(nb::module_ &module) {
  bind_stop_reasons(module);
  bind_agreement(module);
  nb::class_<CertifiedFractions>(module, "CertifiedFractions")
      .def_ro("simplex_ok", &CertifiedFractions::simplex_ok)
      .def_ro("star_ok", &CertifiedFractions::star_ok);
  nb::class_<ResultArrays>(module, "RemeshResult",
                           "A new mesh, the metric at its points, and what happened.")
      .def_ro("mesh", &ResultArrays::mesh)
      .def_ro("metric", &ResultArrays::metric, nb::rv_policy::automatic,
              nb::for_getter(nb::sig("def metric(self) -> NDArray[numpy.float64]")))
      .def_ro(
          "delaunay", &ResultArrays::delaunay, nb::rv_policy::automatic,
          nb::for_getter(nb::sig("def delaunay(self) -> NDArray[numpy.uint8] | None")))
      .def_prop_ro("statistics",
                   [](const ResultArrays &self) { return as_dict(self.statistics); })
      .def_ro("kept_quality", &ResultArrays::kept_quality)
      .def_prop_ro("distortion",
                   [](const ResultArrays &self) { return as_dict(self.distortion); })
      .def_ro("agreement", &ResultArrays::agreement)
      .def_prop_ro("consistency",
                   [](const ResultArrays &self) { return as_dict(self.consistency); })
      .def_prop_ro("consistency_stop",
                   [](const ResultArrays &self) { return self.consistency.stop; })
      .def_prop_ro("certified",
                   [](const ResultArrays &self) { return self.stars.certified; })
      .def_ro("counts", &ResultArrays::counts)
      .def_ro("seconds", &ResultArrays::seconds)
      .def_ro("stop_reason", &ResultArrays::reason);
}

} // namespace anistar::bindings
