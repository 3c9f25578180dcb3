#pragma once
// The phases that make the stars of a mesh Delaunay, once its edges and shapes are
// done: agreement, the certificate with the mending of its last failures, and
// consistency.

#include "base/stopwatch.h"
#include "remesh/remesh_result.h"
#include "remesh/remesh_settings.h"
#include "stars/star_mending.h"

#include <optional>

namespace anistar {

/// As far as the metric, the settings and the budgets let them.
///
/// @tparam Mesh what a dimension adds: `d`; plan(settings): what is to become of
/// agreement, `done` where it is to be made; agree(); is_certified(settings, agreement)
/// and is_mended(agreement); certify(): the answers for all cells, none when it was cut
/// short; mend(known); refine(settings, known): consistency; mesh()
template <class Mesh>
void certify_stars(Mesh &mesh, const Run &run, const RemeshSettings &settings,
                   Stopwatch &watch, RemeshResult<Mesh::d> &out) {
  watch.phase("agreement");
  AgreementReport &agreement = out.agreement;
  agreement = mesh.plan(settings);
  if (agreement.outcome == AgreementOutcome::done) {
    agreement.counts = mesh.agree();
    agreement.stopped_by = run.monitor.reason();
    if (run.is_stopped())
      agreement.outcome = AgreementOutcome::stopped;
  }
  if (!mesh.is_certified(settings, agreement))
    return;
  watch.phase("certificate");
  std::optional<DelaunayBits> known = mesh.certify();
  if (!known)
    return;
  out.stars.failures = failing_cells(mesh.mesh(), known->bits).size();
  if (mesh.is_mended(agreement))
    out.stars.moves = mesh.mend(*known);
  if (settings.consistency != ConsistencyMode::off) {
    watch.phase("consistency");
    out.consistency = mesh.refine(settings, *known);
  }
  out.stars.certified = certified_fractions(mesh.mesh(), known->bits);
}

} // namespace anistar
