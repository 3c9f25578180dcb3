#include "volume/remesh.h"

#include "base/stopwatch.h"
#include "remesh/kept_quality.h"
#include "remesh/star_phases.h"
#include "stars/certify_all.h"
#include "volume/mesh/surface_arrays.h"
#include "volume/passes/shaping.h"
#include "volume/pure/star_set_mesh.h"
#include "volume/stars/agreement.h"
#include "volume/stars/consistency.h"
#include "volume/stars/star_mending.h"

#include <algorithm>

namespace anistar {
namespace {

/// Agreement leaves a star in a hundred, or fewer, on the metrics tried whose ln gamma
/// stays below these bounds on 90 % and on 99 % of the edges.
constexpr double largest_agreeing_p90 = .35, largest_agreeing_p99 = .7;
/// So many cells tell how fast the metric varies.
constexpr std::size_t sampled_cells = 1 << 14;

/// Cells of a mesh without free ones, so many from one to the next.
std::vector<Cell<3>> sample(const std::vector<Cell<3>> &cells) {
  const std::size_t step = std::max<std::size_t>(1, cells.size() / sampled_cells);
  std::vector<Cell<3>> found;
  for (std::size_t c = 0; c < cells.size(); c += step)
    found.push_back(cells[c]);
  return found;
}

/// What certify_stars needs of a mesh of tetrahedra, which was renumbered.
class VolumeStars {
public:
  static constexpr std::size_t d = 3;

  VolumeStars(Volume &volume, const Run &run, const RemeshSettings &settings)
      : volume_(volume), run_(run),
        effort_(settings.agreement == AgreementMode::on ||
                        settings.consistency != ConsistencyMode::off
                    ? full_effort
                    : small_effort) {}

  [[nodiscard]] const Triangulation<3> &mesh() const { return volume_.mesh; }

  [[nodiscard]] std::optional<AgreementReport>
  refusal(const RemeshSettings &settings) const {
    (void)run_.monitor.look(0); // small meshes come here without a look at the clock
    if (settings.agreement == AgreementMode::off)
      return AgreementReport{.outcome = AgreementOutcome::off};
    if (run_.is_stopped())
      // the cells of a mesh that is not refined can reach across the whole domain
      return AgreementReport{.outcome = AgreementOutcome::stopped_before,
                             .stopped_by = run_.monitor.reason()};
    const DistortionQuantiles gamma =
        distortion_quantiles(mesh().vertices, sample(mesh().cells), run_.threads);
    if (gamma.p90 > largest_agreeing_p90)
      return varies_too_fast(90, gamma.p90, largest_agreeing_p90);
    if (gamma.p99 > largest_agreeing_p99)
      return varies_too_fast(99, gamma.p99, largest_agreeing_p99);
    return {};
  }
  AgreementCounts agree() {
    const AgreementCounts counts = anistar::agree(volume_, run_, effort_);
    renumber(volume_, run_.threads);
    return counts;
  }
  /// Where agreement was made, or it or consistency was asked for, unless a budget has
  /// been spent.
  [[nodiscard]] bool is_certified(const RemeshSettings &settings,
                                  const AgreementReport &agreement) const {
    return !run_.is_stopped() &&
           (agreement.was_tried() || settings.agreement == AgreementMode::on ||
            settings.consistency != ConsistencyMode::off);
  }
  [[nodiscard]] std::optional<DelaunayBits> certify() const {
    DelaunayBits known =
        delaunay_bits<3>(certified(mesh()), run_.threads,
                         [&](double fraction) { return run_.monitor.look(fraction); });
    return run_.is_stopped() ? std::nullopt : std::optional(std::move(known));
  }
  [[nodiscard]] static bool is_mended(const AgreementReport &) { return true; }
  MendingCounts mend(DelaunayBits &known) {
    return mend_stars(volume_, run_, effort_, known);
  }
  [[nodiscard]] ConsistencyCounts refine(const RemeshSettings &settings,
                                         DelaunayBits &known) {
    return refine_until_consistent(volume_, run_, settings, known);
  }

private:
  Volume &volume_;
  const Run &run_;
  AgreementEffort effort_;
};

/// Whether insertions have left free cells or vertices behind.
bool has_gaps(const Triangulation<3> &mesh) {
  const auto is_free = [](const Cell<3> &cell) { return cell[0] == none; };
  return std::any_of(mesh.cells.begin(), mesh.cells.end(), is_free) ||
         std::find(mesh.vertex_cell.begin(), mesh.vertex_cell.end(), none) !=
             mesh.vertex_cell.end();
}

/// Drops them.
void compact(Volume &volume, int threads, PerCell<std::uint8_t> &delaunay) {
  const PerCell<Index> old_cell = renumber(volume, threads);
  PerCell<std::uint8_t> moved(old_cell.size());
  for (std::size_t c = 0; c < moved.size(); ++c)
    moved[c] = delaunay[old_cell[c]];
  delaunay = std::move(moved);
}

void take_mesh(Triangulation<3> &mesh, std::span<const RidgeEdge> ridges,
               const SurfaceShape &surface, VolumeResult &out) {
  SurfaceArrays arrays = surface_arrays(mesh, ridges, surface);
  out.facets = std::move(arrays.facets);
  out.facet_tags = std::move(arrays.facet_tags);
  out.edges = std::move(arrays.edges);
  out.edge_tags = std::move(arrays.edge_tags);
  out.vertices = std::move(mesh.vertices);
  out.cells = std::move(mesh.cells);
  out.cell_tags = std::move(mesh.region);
  out.is_curved = surface.is_curved();
}

/// The mesh by the algorithm of the paper alone, with its certificate. @returns whether
/// there is one
bool take_pure_mesh(const Volume &start, std::span<const Index> region, const Run &run,
                    const RemeshSettings &settings, Stopwatch &watch,
                    VolumeResult &out) {
  watch.phase("consistency");
  StarSetMesh pure = mesh_by_stars(start, region, run, settings.parameters);
  out.consistency = pure.counts;
  out.n_sites = pure.n_sites;
  if (!pure.exists())
    return false;
  Triangulation<3> &mesh = pure.merged.mesh;
  watch.phase("certificate");
  DelaunayBits known = certify_all(mesh, run);
  out.stars.failures = failing_cells(mesh, known.bits).size();
  out.stars.certified = certified_fractions(mesh, known.bits);
  out.delaunay = std::move(known.bits);
  out.kept_quality = kept_quality<3>(mesh.vertices, mesh.cells, run.threads);
  take_mesh(mesh, pure.merged.ridges, start.surface, out);
  return true;
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

/// The given mesh, changed until its edges have unit length.
template <class Start>
void remesh_by_passes(const Start &make_start, const Run &run,
                      const RemeshSettings &settings, Stopwatch &watch,
                      VolumeResult &out) {
  const Shaping shaping = shape_volume(
      [&] {
        Volume start = make_start();
        if (settings.agreement != AgreementMode::off)
          rest_where_agreed(start, run);
        return start;
      },
      run, watch);
  Volume &volume = *shaping.volume;
  VolumeStars stars(volume, run, settings);
  certify_stars(stars, run, settings, watch, out);
  if (out.stars.certified && has_gaps(volume.mesh))
    compact(volume, run.threads, out.delaunay);
  watch.phase("report");
  out.kept_quality = shaping.kept;
  take_mesh(volume.mesh, volume.ridges.edges(), volume.surface, out);
  out.passes = shaping.counts;
  const bool is_over = shaping.is_full || out.vertices.size() > settings.max_vertices;
  out.reason = run.monitor.reason();
  // what the clock has ended may end elsewhere the next time: that is told first
  if (is_over && out.reason == StopReason::finished)
    out.reason = StopReason::max_vertices;
}

} // namespace

VolumeResult remesh_volume(const VolumeInput &input,
                           std::span<const SymmetricTensor<3>> metric,
                           const SurfaceInput &geometry, SurfaceProjection projection,
                           const RemeshSettings &settings, Monitor::Progress progress) {
  VolumeResult out;
  Monitor monitor(std::move(progress), settings.max_vertices, settings.max_seconds);
  const Run run{monitor, settings.hausdorff, {settings.seed}, settings.threads};
  Stopwatch watch(monitor, out.seconds);

  { // what the mesh is made with is freed before the report, which takes room too
    watch.phase("background");
    const Background<3> background(input.surface.points, input.cells, metric,
                                   settings.threads);
    const SurfaceProjection project = timed(std::move(projection), monitor);
    const auto make_start = [&] {
      return make_volume(input, metric, background, geometry, project);
    };
    if (settings.consistency != ConsistencyMode::pure) {
      remesh_by_passes(make_start, run, settings, watch, out);
    } else if (!take_pure_mesh(make_start(), input.cell_tags, run, settings, watch,
                               out)) {
      RemeshSettings otherwise = settings;
      otherwise.consistency = ConsistencyMode::off;
      remesh_by_passes(make_start, run, otherwise, watch, out);
    }
  }
  const auto edges = edges_of<3>(out.cells, out.vertices.size());
  out.statistics = measure(out.vertices, out.cells, edges, settings.threads);
  out.distortion = distortion_quantiles(out.vertices, edges, settings.threads);
  watch.stop();
  return out;
}

} // namespace anistar
