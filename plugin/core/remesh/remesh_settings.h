#pragma once
// What the remeshers of both dimensions are told.

#include "base/run.h"
#include "remesh/domain_shape.h"
#include "stars/rules.h"

namespace anistar {

/// Whether vertices are moved until the stars agree. `when_possible` asks the metric:
/// it must not vary too fast from vertex to vertex; in 3D only for insertions to
/// follow.
enum class AgreementMode { off, when_possible, on };

struct RemeshSettings {
  DomainShape shape{};
  HausdorffNumbers hausdorff{};
  std::size_t max_vertices = std::numeric_limits<std::size_t>::max();
  double max_seconds = std::numeric_limits<double>::infinity();
  AgreementMode agreement = AgreementMode::when_possible;
  ConsistencyMode consistency = ConsistencyMode::off;
  ConsistencyParameters parameters{};
  std::uint64_t seed = 0;
  int threads = 1;
};

} // namespace anistar
