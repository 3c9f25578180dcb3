#pragma once
// Phase 4 in 3D: the mesh is changed until the metrics of neighbours agree about every
// facet.

#include "base/run.h"
#include "volume/mesh/volume.h"

#include <cstdint>

namespace anistar {

/// Why agreement ended.
enum class AgreementStop { agreed, stalled, rounds, trials, interrupted };

[[nodiscard]] inline const char *name_of(AgreementStop stop) {
  switch (stop) {
  case AgreementStop::agreed:
    return "agreed";
  case AgreementStop::stalled:
    return "stalled";
  case AgreementStop::rounds:
    return "too many rounds";
  case AgreementStop::trials:
    return "too many trials";
  case AgreementStop::interrupted:
    return "interrupted";
  }
  return "unknown";
}

struct VolumeAgreementCounts {
  std::size_t facets_before = 0, facets_after = 0; ///< on which five metrics disagree
  std::size_t trials = 0, moves = 0, swaps = 0, reinsertions = 0, repairs = 0,
              polishes = 0;
  int rounds = 0;
  AgreementStop stop = AgreementStop::agreed;
};

/// Swaps, re-insertions and moves at the facets that fail the five-metric test (see
/// facet_margin), scored by the exact change in their number; where these are stuck, a
/// collapse or an insertion; then a polish of the shapes that lets no more facets fail.
/// The list of failing facets is maintained, the mesh is searched
/// once, on several threads. No quality
/// falls below agreement_floor that was not below before.
/// @param hausdorff_number of curved surfaces, as in VolumePasses
/// @param persistence so many times the rounds and trials, for what is stuck
VolumeAgreementCounts agree_volume(Volume &volume, Monitor &monitor,
                                   double hausdorff_number, Seed seed, int threads,
                                   int persistence = 1);

} // namespace anistar
