#pragma once
// The phases that make the stars of a mesh Delaunay, once its edges and shapes are
// done: agreement, the certificate with the mending of its last failures, and
// consistency.

#include "base/stopwatch.h"
#include "remesh/remesh_result.h"
#include "remesh/remesh_settings.h"
#include "stars/rules.h"

#include <optional>

namespace anistar {

/// As far as the metric, the settings and the budgets let them.
///
/// @tparam Stars what a dimension adds: `d`; refusal(settings): why agreement is
/// not made, none where it is; agree(); is_certified(settings, agreement) and
/// is_mended(agreement); certify(): the answers for all cells, none when it was cut
/// short; mend(known); refine(settings, known): consistency; mesh()
/// out.delaunay is left in the numbering of stars.mesh().
template <class Stars>
void certify_stars(Stars &stars, const Run &run, const RemeshSettings &settings,
                   Stopwatch &watch, RemeshResult<Stars::d> &out) {
  watch.phase("agreement");
  AgreementReport &agreement = out.agreement;
  if (const auto refusal = stars.refusal(settings)) {
    agreement = *refusal;
  } else {
    agreement.counts = stars.agree();
    agreement.outcome =
        run.is_stopped() ? AgreementOutcome::stopped : AgreementOutcome::done;
    agreement.stopped_by = run.monitor.reason();
  }
  if (!stars.is_certified(settings, agreement))
    return;
  watch.phase("certificate");
  std::optional<DelaunayBits> known = stars.certify();
  if (!known)
    return;
  out.stars.failures = failing_cells(stars.mesh(), known->bits).size();
  if (stars.is_mended(agreement)) {
    const MendingCounts mended = stars.mend(*known);
    out.stars.moves = mended.moves;
    if (agreement.was_tried())
      agreement.counts.after += static_cast<std::size_t>(mended.more_failing);
  }
  if (settings.consistency != ConsistencyMode::off) {
    watch.phase("consistency");
    out.consistency = stars.refine(settings, *known);
  }
  out.stars.certified = certified_fractions(stars.mesh(), known->bits);
  out.delaunay = std::move(known->bits);
}

} // namespace anistar
