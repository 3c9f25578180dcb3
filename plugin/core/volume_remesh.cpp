#include "volume_remesh.h"

#include "stopwatch.h"

namespace anistar {
namespace {

/// Lengths are brought down step by step: larger steps leave pockets where the cells
/// are stuck, and splitting everything at once makes far too many vertices.
constexpr double growth_step = 1.5;
constexpr double longest_edge = 1.5;
constexpr int max_growth_rounds = 60, max_converged_rounds = 6;
/// The next step is taken, and growth ends, when a round splits fewer than these
/// fractions of the vertices.
constexpr double step_is_dry = .02, growth_is_dry = .03;
/// The mesh is sorted again when it has grown by this.
constexpr double growth_between_sorts = 1.6;
/// Sweeps over the whole mesh at its final size.
constexpr int n_sweeps = 3;

/// Phase 2: the longest edges first, with swaps, moves and re-insertion in between.
void grow(Volume &volume, VolumePasses &passes, int threads) {
  double threshold = std::max(longest_edge, passes.longest_edge() / growth_step);
  std::size_t sorted_at = volume.n_vertices();
  int converged = 0;
  bool is_lowered = false;
  for (int round = 0; round < max_growth_rounds && !passes.is_stopped(); ++round) {
    const bool is_last_step = threshold <= longest_edge;
    if (is_lowered)
      passes.look_everywhere(Pass::split);
    const std::size_t splits = passes.split({threshold, 1e-4, .45, .5});
    passes.swap(.5);
    passes.vertices({is_last_step ? .6 : .5, std::max(longest_edge, threshold), true});
    if (static_cast<double>(volume.mesh.vertices.size()) >
        growth_between_sorts * static_cast<double>(sorted_at)) {
      renumber(volume, threads);
      sorted_at = volume.n_vertices();
    }
    passes.repair(.1);
    const double fraction =
        static_cast<double>(splits) / static_cast<double>(volume.n_vertices());
    if (is_last_step &&
        (fraction < growth_is_dry || ++converged >= max_converged_rounds))
      break;
    is_lowered = !is_last_step && fraction < step_is_dry;
    if (is_lowered)
      threshold = std::max(longest_edge, threshold / growth_step);
  }
  renumber(volume, threads);
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

} // namespace

VolumeResult remesh_volume(const VolumeInput &input,
                           std::span<const SymmetricTensor<3>> metric,
                           const SurfaceInput &geometry, SurfaceProjection projection,
                           const VolumeSettings &settings, Monitor::Progress progress) {
  VolumeResult out;
  Monitor monitor(std::move(progress), settings.max_vertices, settings.max_seconds);
  Stopwatch watch(monitor, out.seconds);

  watch.phase("background");
  const Background<3> background(input.surface.points, input.cells, metric,
                                 settings.threads);
  Volume volume =
      make_volume(input, metric, background, geometry, std::move(projection));
  VolumePasses passes(volume, monitor, settings.hausdorff_number, settings.seed,
                      settings.threads);
  watch.phase("size");
  grow(volume, passes, settings.threads);
  watch.phase("shape");
  shape(passes);
  renumber(volume, settings.threads);

  watch.phase("report");
  extract_facets(volume, out);
  out.vertices = std::move(volume.mesh.vertices);
  out.cells = std::move(volume.mesh.cells);
  out.cell_tags = std::move(volume.mesh.region);
  out.statistics = measure(out.vertices, out.cells, settings.threads);
  out.distortion = distortion_quantiles(out.vertices, out.cells, settings.threads);
  watch.stop();
  const VolumeCounts &counts = passes.counts();
  for (const auto &[name, value] : {std::pair{"splits", counts.splits},
                                    {"collapses", counts.collapses},
                                    {"edge_swaps", counts.edge_swaps},
                                    {"face_swaps", counts.face_swaps},
                                    {"moves", counts.moves},
                                    {"insertions", counts.insertions},
                                    {"repairs", counts.repairs}})
    out.counts[name] = static_cast<double>(value);
  out.reason = passes.is_full() ? StopReason::max_vertices : monitor.reason();
  return out;
}

} // namespace anistar
