#include "volume/remesh.h"

#include "base/stopwatch.h"
#include "certificate/star_failures.h"
#include "volume/agreement.h"
#include "volume/consistency.h"
#include "volume/star_check.h"

#include <iomanip>
#include <sstream>

namespace anistar {
namespace {

/// Lengths are brought down step by step: larger steps leave pockets where the cells
/// are stuck, and splitting everything at once makes far too many vertices.
constexpr double growth_step = 1.5;
constexpr double longest_edge = 1.5;
constexpr int max_surface_rounds = 12;
constexpr int max_growth_rounds = 60, max_converged_rounds = 6;
/// The next step is taken, and growth ends, when a round splits fewer than these
/// fractions of the vertices.
constexpr double step_is_dry = .02, growth_is_dry = .03;
/// Growth ends as well when a round changes the number of vertices by less than this:
/// where the metric is steep some edges are split and collapsed for ever. Or when the
/// repairs take away this fraction of what was split. A step above the last ends after
/// as many such rounds, for the next one to go on elsewhere.
constexpr double steady = .01, undone = .5;
constexpr int max_steady_rounds = 2;
/// The mesh is sorted again when it has grown by this.
constexpr double growth_between_sorts = 1.6;
/// Or when this fraction of its vertices came or went; but while it grows not one of so
/// few cells, which the cache holds in any order.
constexpr double change_between_sorts = .1;
constexpr std::size_t cached_cells = 1 << 15;
/// Sweeps over the whole mesh at its final size.
constexpr int n_sweeps = 3;
/// Where the metric is steep, all is polished, several times; else what is below this.
constexpr int n_steep_polishes = 3;
constexpr double polished_below = .5;

/// Agreement certified at least 99.5 % of the cells on the metrics tried whose ln gamma
/// stays below .3 on 90 % of the edges, and at least 97 % up to the first bound here;
/// the second one is for 99 % of the edges.
constexpr double largest_agreeing_p90 = .35, largest_agreeing_p99 = .6;

/// Keeps a mesh sorted along its curve while vertices come and go: what is near in
/// space must be near in memory, or most of the time goes into waiting for it.
class CurveOrder {
public:
  CurveOrder(Volume &volume, const VolumePasses &passes, int threads)
      : volume_(volume), passes_(passes), threads_(threads),
        n_vertices_(volume.n_vertices()) {}

  void restore() {
    const bool has_grown = static_cast<double>(volume_.mesh.vertices.size()) >
                           growth_between_sorts * static_cast<double>(n_vertices_);
    const bool is_scattered =
        volume_.mesh.cells.size() > cached_cells && has_changed(n_changes_);
    if (!has_grown && !is_scattered)
      return;
    renumber(volume_, threads_);
    n_vertices_ = volume_.n_vertices();
    n_changes_ = n_changes();
  }
  void finish() {
    if (has_changed(0))
      renumber(volume_, threads_);
  }

private:
  Volume &volume_;
  const VolumePasses &passes_;
  int threads_;
  std::size_t n_vertices_, n_changes_ = 0; ///< at the last sort

  [[nodiscard]] std::size_t n_changes() const {
    return passes_.counts().splits + passes_.counts().collapses;
  }
  [[nodiscard]] bool has_changed(std::size_t since) const {
    return static_cast<double>(n_changes() - since) >
           change_between_sorts * static_cast<double>(volume_.n_vertices());
  }
};

/// Phase 2: the longest edges first, with swaps, moves and re-insertion in between.
void grow(Volume &volume, VolumePasses &passes, int threads) {
  for (int round = 0; round < max_surface_rounds; ++round)
    if (passes.follow_surfaces() == 0)
      break;
  double threshold = std::max(longest_edge, passes.longest_edge() / growth_step);
  CurveOrder order(volume, passes, threads);
  int converged = 0, n_steady = 0;
  bool is_lowered = false;
  for (int round = 0; round < max_growth_rounds && !passes.is_stopped(); ++round) {
    const bool is_last_step = threshold <= longest_edge;
    if (is_lowered)
      passes.look_everywhere(Pass::split);
    const auto before = static_cast<double>(volume.n_vertices());
    const std::size_t splits = passes.split({threshold, 1e-4, .45, .5});
    passes.swap(.5);
    passes.vertices({is_last_step ? .6 : .5, std::max(longest_edge, threshold), true});
    order.restore();
    const auto unrepaired = static_cast<double>(volume.n_vertices());
    passes.repair(.1);
    const auto after = static_cast<double>(volume.n_vertices());
    const double fraction = static_cast<double>(splits) / after;
    const bool is_steady =
        std::abs(after / before - 1) < steady ||
        (splits > 0 && unrepaired - after > undone * static_cast<double>(splits));
    if (is_last_step &&
        (fraction < growth_is_dry || is_steady || ++converged >= max_converged_rounds))
      break;
    n_steady = is_steady ? n_steady + 1 : 0;
    is_lowered =
        !is_last_step && (fraction < step_is_dry || n_steady >= max_steady_rounds);
    if (is_lowered) {
      threshold = std::max(longest_edge, threshold / growth_step);
      n_steady = 0;
    }
  }
  order.finish();
}

/// Phase 3: sweeps at the final size.
void shape(VolumePasses &passes) {
  for (int sweep = 0; sweep < n_sweeps && !passes.is_stopped(); ++sweep) {
    (void)passes.split({longest_edge, .15, .5});
    passes.swap(.7);
    passes.vertices({.62, longest_edge, sweep + 1 < n_sweeps});
    passes.repair(.3);
  }
  passes.swap(.7);
  const bool is_steep = passes.is_metric_steep();
  for (int k = 0; k < (is_steep ? n_steep_polishes : 1) && !passes.is_stopped(); ++k) {
    if (k > 0)
      (void)passes.split({longest_edge, .25, .5});
    passes.polish(is_steep ? 1 : polished_below);
  }
}

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
  const VolumeAgreementCounts agreed = agree_volume(
      volume, monitor, settings.hausdorff.surface, settings.seed, settings.threads);
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
  out.counts["star_moves"] = static_cast<double>(
      mend_stars(volume, monitor, settings.hausdorff.surface, settings.seed, known));
  if (inserting) {
    watch.phase("consistency");
    out.consistency = refine_until_consistent(volume, monitor, settings.parameters,
                                              settings.hausdorff.surface, settings.seed,
                                              settings.threads, known);
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
    Volume volume = make_volume(input, metric, background, geometry,
                                timed(std::move(projection), monitor));
    VolumePasses passes(volume, monitor, settings.hausdorff, settings.seed,
                        settings.threads);
    watch.phase("size");
    grow(volume, passes, settings.threads);
    watch.phase("shape");
    shape(passes);
    renumber(volume, settings.threads);
    watch.phase("agreement");
    agree(volume, monitor, settings, out);
    certify_stars(volume, monitor, settings, watch, out);
    watch.phase("report");
    take_mesh(volume, out);
    take_counts(passes.counts(), out);
    const bool is_over =
        passes.is_full() || out.vertices.size() > settings.max_vertices;
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
