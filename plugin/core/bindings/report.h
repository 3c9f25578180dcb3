#pragma once
// What the remeshers of both dimensions report.

#include "../agreement_mode.h"
#include "../monitor.h"
#include "../statistics.h"
#include "arrays.h"

namespace anistar::bindings {

/// Points (n, d) and full tensors (n, d, d) of vertices.
template <std::size_t d>
void put_vertices(nb::dict &result, const std::vector<Vertex<d>> &vertices) {
  std::vector<double> points, metric;
  points.reserve(vertices.size() * d);
  metric.reserve(vertices.size() * d * d);
  for (const Vertex<d> &v : vertices) {
    points.insert(points.end(), v.x.data(), v.x.data() + d);
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t j = 0; j < d; ++j)
        metric.push_back(v.M(i, j));
  }
  result["points"] = owned(std::move(points), {vertices.size(), d});
  result["metric"] = owned(std::move(metric), {vertices.size(), d, d});
}

[[nodiscard]] nb::dict as_dict(const Statistics &statistics);
[[nodiscard]] nb::dict as_dict(const DistortionQuantiles &quantiles);

/// @throws std::invalid_argument for an unknown name
[[nodiscard]] AgreementMode agreement_mode(const std::string &name);

/// The certified fractions; None when they are not known.
void put_certified(nb::dict &result, bool was_checked, double simplex_ok,
                   double star_ok);

/// Tells Python about progress and lets it interrupt: Ctrl-C, or an exception in the
/// user's callback, unwinds the core.
/// A handle, not an object: it is copied and destroyed while the GIL is released.
[[nodiscard]] Monitor::Progress progress_of(nb::handle callback);

} // namespace anistar::bindings
