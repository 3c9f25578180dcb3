#pragma once
// Gradation: a bound on how fast a metric may change along the edges of a graph.

#include "base/tensor.h"
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace anistar {

/// How a metric M_p grows with the distance from p (b is the gradation factor):
/// each eigenvalue by itself, lambda / (1 + sqrt(lambda) |pq| ln b)^2; all by one
/// factor, M_p / (1 + l ln b)^2 with l the length of pq in M_p; or the geometric mean
/// of the two with weights 1/8 and 7/8. None asks nothing of its own. Source: Alauzet,
/// Size gradation control of anisotropic meshes, 2010, sections 6.1, 6.2.
enum class GrowthModel { None, Physical, Metric, Mixed };

enum class GradationStop { Converged, RoundLimit };

struct GradationOptions {
  GrowthModel model;
  double log_factor; ///< ln b > 0
  double
      max_distortion; ///< of a unit edge: growth stays below 1 + l times this; or inf
  double tolerance;   ///< a metric is raised only where this share is missing
  std::size_t max_rounds;
  std::function<void()> look; ///< called now and then; may throw, to interrupt
};

template <std::size_t d> struct Graded {
  std::vector<SymmetricTensor<d>> metric;
  std::size_t rounds = 0;
  std::size_t updates = 0;
  GradationStop stop = GradationStop::Converged;
};

/// Raises `metric` until M_q is at least the grown M_p for all neighbours p, q.
/// The work queue holds the vertices that were raised; a round takes the densest of
/// them and intersects, the densest first, what they ask with their neighbours.
/// Never coarsens, leaves a graded metric untouched, and does not depend on how the
/// points are numbered.
/// @pre the metrics are positive definite; neighbours of v are neighbours[offsets[v]]
/// to
///      neighbours[offsets[v + 1]], all in range.
template <std::size_t d>
[[nodiscard]] Graded<d>
graded(std::span<const Vector<d>> points, std::vector<SymmetricTensor<d>> metric,
       std::span<const std::int32_t> offsets, std::span<const std::int32_t> neighbours,
       const GradationOptions &options);

extern template Graded<2> graded<2>(std::span<const Vector<2>>,
                                    std::vector<SymmetricTensor<2>>,
                                    std::span<const std::int32_t>,
                                    std::span<const std::int32_t>,
                                    const GradationOptions &);
extern template Graded<3> graded<3>(std::span<const Vector<3>>,
                                    std::vector<SymmetricTensor<3>>,
                                    std::span<const std::int32_t>,
                                    std::span<const std::int32_t>,
                                    const GradationOptions &);

} // namespace anistar
