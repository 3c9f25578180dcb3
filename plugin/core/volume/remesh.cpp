#include "volume/remesh.h"

#include "base/stopwatch.h"
#include "stars/star_mending.h"
#include "volume/passes/shaping.h"
#include "volume/stars/agreement.h"
#include "volume/stars/consistency.h"
#include "volume/stars/star_mending.h"

#include <iomanip>
#include <sstream>

namespace anistar {
namespace {

/// Agreement certified at least 99.5 % of the cells on the metrics tried whose ln gamma
/// stays below .3 on 90 % of the edges, and at least 97 % up to the first bound here;
/// the second one is for 99 % of the edges.
constexpr double largest_agreeing_p90 = .35, largest_agreeing_p99 = .6;

std::string quotient(double value, double bound) {
  std::ostringstream text;
  text << std::setprecision(2) << value << " > " << bound;
  return text.str();
}

/// Why there will be no agreement; empty when there will be.
std::string reason_to_skip(const Volume &volume, const Monitor &monitor,
                           const RemeshSettings &settings) {
  if (settings.agreement == AgreementMode::off)
    return "off";
  if (monitor.reason() != StopReason::finished)
    // the cells of a mesh that is not refined can reach across the whole domain
    return std::string("skipped: stopped by ") + name_of(monitor.reason());
  // it takes as long as all the rest, for a property that only some ask for
  if (settings.agreement == AgreementMode::when_possible &&
      settings.consistency == ConsistencyMode::off)
    return "skipped: not asked for, and in 3D it takes as long as the remeshing";
  const DistortionQuantiles gamma =
      distortion_quantiles(volume.mesh.vertices, volume.mesh.cells, settings.threads);
  const std::string too_fast = "skipped: the metric varies too fast, ln gamma ";
  if (gamma.p90 > largest_agreeing_p90)
    return too_fast + "p90 " + quotient(gamma.p90, largest_agreeing_p90);
  if (gamma.p99 > largest_agreeing_p99)
    return too_fast + "p99 " + quotient(gamma.p99, largest_agreeing_p99);
  return "";
}

/// Phase 4, as far as the metric and the settings let it. @pre the mesh was renumbered.
void agree(Volume &volume, Monitor &monitor, const RemeshSettings &settings,
           VolumeResult &out) {
  (void)monitor.look(0); // small meshes come here without a look at the clock
  out.agreement = reason_to_skip(volume, monitor, settings);
  if (!out.agreement.empty())
    return;
  const VolumeAgreementCounts agreed =
      agree_volume(volume, monitor, settings.hausdorff.surface, Seed{settings.seed},
                   settings.threads);
  renumber(volume, settings.threads);
  out.agreement = "done";
  if (agreed.facets_after > 0)
    out.agreement += std::string(", ") + name_of(agreed.stop) + " with " +
                     std::to_string(agreed.facets_after) + " facets left";
  for (const auto &[name, value] :
       {std::pair{"disagreeing_before", agreed.facets_before},
        {"disagreeing_after", agreed.facets_after},
        {"trials", agreed.trials},
        {"relocations", agreed.moves},
        {"agreement_swaps", agreed.swaps},
        {"agreement_insertions", agreed.reinsertions},
        {"agreement_repairs", agreed.repairs},
        {"polishes", agreed.polishes},
        {"agreement_rounds", static_cast<std::size_t>(agreed.rounds)}})
    out.counts[name] = static_cast<double>(value);
}

void extract_facets(const Volume &volume, VolumeResult &out) {
  const Triangulation<3> &mesh = volume.mesh;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    if (!volume.is_walled(static_cast<Index>(c)))
      continue;
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet h(static_cast<Index>(c), i), beyond = mesh.opposite(h);
      if (mesh.constraint(h) == none || (beyond.exists() && beyond.cell() < h.cell()))
        continue;
      const Facet<3> t = mesh.facet(h);
      out.facets.push_back({t[0], t[2], t[1]});
      out.facet_tags.push_back(volume.surface.patch(mesh.constraint(h)).tag);
    }
  }
  for (const RidgeEdge &edge : volume.ridges.edges()) {
    if (edge.ends[0] == none || !volume.surface.curve(edge.curve).is_given)
      continue;
    out.edges.push_back(edge.ends);
    out.edge_tags.push_back(volume.surface.curve(edge.curve).tag);
  }
}

void take_mesh(Volume &volume, VolumeResult &out) {
  extract_facets(volume, out);
  out.vertices = std::move(volume.mesh.vertices);
  out.cells = std::move(volume.mesh.cells);
  out.cell_tags = std::move(volume.mesh.region);
  out.counts["curved"] = volume.surface.is_curved() ? 1 : 0;
}

void take_counts(const VolumeCounts &counts, VolumeResult &out) {
  for (const auto &[name, value] : {std::pair{"splits", counts.splits},
                                    {"collapses", counts.collapses},
                                    {"edge_swaps", counts.edge_swaps},
                                    {"face_swaps", counts.face_swaps},
                                    {"moves", counts.moves},
                                    {"insertions", counts.insertions},
                                    {"repairs", counts.repairs}})
    out.counts[name] = static_cast<double>(value);
}

/// Phases 5 and 6 where agreement or consistency was asked for, unless a budget has
/// been spent: the certificate takes longer than a pass. @pre the mesh was renumbered.
void certify_stars(Volume &volume, Monitor &monitor, const RemeshSettings &settings,
                   Stopwatch &watch, VolumeResult &out) {
  const bool inserting = settings.consistency != ConsistencyMode::off;
  if (monitor.reason() != StopReason::finished ||
      (settings.agreement != AgreementMode::on && !inserting))
    return;
  watch.phase("certificate");
  DelaunayBits known =
      delaunay_bits<3>(certified(volume.mesh), settings.threads,
                       [&](double fraction) { return monitor.look(fraction); });
  if (monitor.reason() != StopReason::finished)
    return;
  out.counts["star_failures"] =
      static_cast<double>(failing_cells(volume.mesh, known.bits).size());
  out.counts["star_moves"] = static_cast<double>(mend_stars(
      volume, monitor, settings.hausdorff.surface, Seed{settings.seed}, known));
  if (inserting) {
    watch.phase("consistency");
    out.consistency = refine_until_consistent(
        volume, monitor, settings.parameters, settings.hausdorff.surface,
        Seed{settings.seed}, settings.threads, known);
    out.counts["consistency_moves"] = static_cast<double>(out.consistency.moves);
  }
  const CertifiedFractions fractions = certified_fractions(volume.mesh, known.bits);
  out.was_checked = true;
  out.simplex_ok = fractions.simplex_ok;
  out.star_ok = fractions.star_ok;
  renumber(volume, settings.threads);
}

/// The user's projection, each call of which may take long.
SurfaceProjection timed(SurfaceProjection projection, Monitor &monitor) {
  if (!projection)
    return {};
  return [projection = std::move(projection), &monitor](const Vector<3> &x, Index tag) {
    const Vector<3> moved = projection(x, tag);
    monitor.note_time();
    return moved;
  };
}

} // namespace

VolumeResult remesh_volume(const VolumeInput &input,
                           std::span<const SymmetricTensor<3>> metric,
                           const SurfaceInput &geometry, SurfaceProjection projection,
                           const RemeshSettings &settings, Monitor::Progress progress) {
  VolumeResult out;
  Monitor monitor(std::move(progress), settings.max_vertices, settings.max_seconds);
  Stopwatch watch(monitor, out.seconds);

  { // what the mesh is made with is freed before the report, which takes room too
    watch.phase("background");
    const Background<3> background(input.surface.points, input.cells, metric,
                                   settings.threads);
    const SurfaceProjection project = timed(std::move(projection), monitor);
    const Shaping shaping = shape_volume(
        [&] { return make_volume(input, metric, background, geometry, project); },
        monitor, settings.hausdorff, Seed{settings.seed}, settings.threads, watch);
    Volume &volume = *shaping.volume;
    watch.phase("agreement");
    agree(volume, monitor, settings, out);
    certify_stars(volume, monitor, settings, watch, out);
    watch.phase("report");
    out.kept_quality = shaping.kept;
    take_mesh(volume, out);
    take_counts(shaping.counts, out);
    const bool is_over = shaping.is_full || out.vertices.size() > settings.max_vertices;
    out.reason = monitor.reason();
    // what the clock has ended may end elsewhere the next time: that is told first
    if (is_over && out.reason == StopReason::finished)
      out.reason = StopReason::max_vertices;
  }
  const auto edges = edges_of<3>(out.cells, out.vertices.size());
  out.statistics = measure(out.vertices, out.cells, edges, settings.threads);
  out.distortion = distortion_quantiles(out.vertices, edges, settings.threads);
  watch.stop();
  return out;
}

} // namespace anistar
