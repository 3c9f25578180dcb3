#include "metric/gradation.h"
#include "bindings/support/arrays.h"
#include "bindings/support/interrupt.h"

#include <nanobind/stl/string.h>
#include <stdexcept>
#include <string>

namespace anistar::bindings {
namespace {

GrowthModel growth_model(const std::string &name) {
  if (name == "none")
    return GrowthModel::None;
  if (name == "physical")
    return GrowthModel::Physical;
  if (name == "metric")
    return GrowthModel::Metric;
  if (name == "mixed")
    return GrowthModel::Mixed;
  throw std::invalid_argument("unknown gradation model '" + name + "'");
}

template <std::size_t d>
std::vector<SymmetricTensor<d>> as_tensors(const double *full, std::size_t n) {
  std::vector<SymmetricTensor<d>> tensors(n);
  for (std::size_t v = 0; v < n; ++v)
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t j = 0; j <= i; ++j)
        tensors[v](i, j) = full[(v * d + i) * d + j];
  return tensors;
}

template <std::size_t d>
std::vector<double> as_full(const std::vector<SymmetricTensor<d>> &tensors) {
  std::vector<double> full(tensors.size() * d * d);
  for (std::size_t v = 0; v < tensors.size(); ++v)
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t j = 0; j < d; ++j)
        full[(v * d + i) * d + j] = tensors[v](i, j);
  return full;
}

void check_graph(std::span<const std::int32_t> offsets,
                 std::span<const std::int32_t> neighbours, std::size_t n) {
  if (offsets.size() != n + 1 || offsets[0] != 0 ||
      std::cmp_not_equal(offsets[n], neighbours.size()))
    throw std::invalid_argument("the offsets do not fit the points and neighbours");
  for (std::size_t v = 0; v < n; ++v)
    if (offsets[v] > offsets[v + 1])
      throw std::invalid_argument("the offsets decrease at point " + std::to_string(v));
  for (const std::int32_t q : neighbours)
    if (q < 0 || std::cmp_greater_equal(q, n))
      throw std::invalid_argument("neighbour " + std::to_string(q) +
                                  " is out of range for " + std::to_string(n) +
                                  " points");
}

template <std::size_t d>
nb::tuple grade_in(const double *points, const double *metric, std::size_t n,
                   std::span<const std::int32_t> offsets,
                   std::span<const std::int32_t> neighbours,
                   const GradationOptions &options) {
  Graded<d> out;
  std::vector<double> full;
  {
    nb::gil_scoped_release release;
    std::vector<Vector<d>> places(n);
    for (std::size_t v = 0; v < n; ++v)
      for (std::size_t i = 0; i < d; ++i)
        places[v][static_cast<int>(i)] = points[v * d + i];
    out = graded<d>(places, as_tensors<d>(metric, n), offsets, neighbours, options);
    full = as_full<d>(out.metric);
  }
  return nb::make_tuple(owned(std::move(full), {n, d, d}), out.rounds, out.updates,
                        out.stop == GradationStop::Converged);
}

nb::tuple grade(Array2<double> points, Array3<double> metric,
                Array1<std::int32_t> offsets, Array1<std::int32_t> neighbours,
                const std::string &model, double log_factor, double max_distortion,
                double tolerance, std::size_t max_rounds) {
  const std::size_t n = points.shape(0), d = points.shape(1);
  if ((d != 2 && d != 3) || metric.shape(0) != n || metric.shape(1) != d ||
      metric.shape(2) != d)
    throw std::invalid_argument("metric must have shape (n, d, d) for points (n, d)");
  const std::span<const std::int32_t> starts(offsets.data(), offsets.size());
  const std::span<const std::int32_t> ends(neighbours.data(), neighbours.size());
  check_graph(starts, ends, n);
  const GradationOptions options{growth_model(model), log_factor, max_distortion,
                                 tolerance,           max_rounds, &look_for_signals};
  return d == 2 ? grade_in<2>(points.data(), metric.data(), n, starts, ends, options)
                : grade_in<3>(points.data(), metric.data(), n, starts, ends, options);
}

} // namespace

void bind_gradation(nb::module_ &module) {
  module.def("grade", &grade, nb::arg("points").noconvert(),
             nb::arg("metric").noconvert(), nb::arg("offsets").noconvert(),
             nb::arg("neighbours").noconvert(), nb::kw_only(), nb::arg("model"),
             nb::arg("log_factor"), nb::arg("max_distortion"), nb::arg("tolerance"),
             nb::arg("max_rounds"),
             "Grade a metric (n, d, d) along a graph given by offsets and neighbours; "
             "returns (metric, rounds, updates, converged).");
}

} // namespace anistar::bindings
