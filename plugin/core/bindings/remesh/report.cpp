#include "bindings/remesh/report.h"

#include "bindings/support/geometry.h"
#include "remesh/agreement_text.h"

#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <span>

namespace anistar::bindings {
namespace {

/// Points (n, d) and full tensors (n, d, d) of vertices.
template <std::size_t d>
void put_vertices(nb::dict &out, const std::vector<Vertex<d>> &vertices) {
  std::vector<double> points, metric;
  points.reserve(vertices.size() * d);
  metric.reserve(vertices.size() * d * d);
  for (const Vertex<d> &v : vertices) {
    points.insert(points.end(), v.x.data(), v.x.data() + d);
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t j = 0; j < d; ++j)
        metric.push_back(v.M(i, j));
  }
  out["points"] = owned(std::move(points), {vertices.size(), d});
  out["metric"] = owned(std::move(metric), {vertices.size(), d, d});
}

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

nb::dict as_dict(const ConsistencyCounts &counts) {
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

/// None when the certificate was not asked.
nb::object certified_fraction(const std::optional<CertifiedFractions> &certified,
                              double CertifiedFractions::*value) {
  return certified ? nb::object(nb::float_((*certified).*value)) : nb::none();
}

} // namespace

template <std::size_t d> nb::dict as_dict(const RemeshResult<d> &result) {
  nb::dict out;
  put_vertices<d>(out, result.vertices);
  out["cells"] = rows<Index, d + 1>(result.cells);
  out["cell_tags"] = owned(std::vector(result.cell_tags), {result.cells.size()});
  out["facets"] = rows<Index, d>(result.facets);
  out["facet_tags"] = owned(std::vector(result.facet_tags), {result.facets.size()});
  out["simplex_ok"] =
      certified_fraction(result.stars.certified, &CertifiedFractions::simplex_ok);
  out["star_ok"] =
      certified_fraction(result.stars.certified, &CertifiedFractions::star_ok);
  out["agreement"] = text_of<d>(result.agreement);
  out["consistency"] = as_dict(result.consistency);
  out["distortion"] = as_dict(result.distortion);
  out["statistics"] = as_dict(result.statistics);
  out["kept_quality"] = result.kept_quality;
  out["counts"] = result.counts;
  out["seconds"] = result.seconds;
  out["stop_reason"] = name_of(result.reason);
  return out;
}

template nb::dict as_dict(const RemeshResult<2> &);
template nb::dict as_dict(const RemeshResult<3> &);

} // namespace anistar::bindings
