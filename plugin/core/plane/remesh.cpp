#include "plane/remesh.h"

#include "base/errors.h"
#include "base/stopwatch.h"
#include "plane/geometry/outline.h"
#include "plane/mesh/start.h"
#include "plane/passes/bisection.h"
#include "plane/stars/agreement.h"
#include "plane/stars/consistency.h"
#include "plane/stars/star_mending.h"
#include "remesh/kept_quality.h"
#include "remesh/star_phases.h"
#include "stars/certify_all.h"

namespace anistar {
namespace {

/// Cells below this are split where their edges, near to unit length as they are, make
/// them no better: around a corner that asks for a size far from that of its
/// neighbours.
constexpr double steep_floor = .35;

/// Agreement was reached, but for a few stars, on every metric tried whose ln gamma
/// stays below this on 99 % of the unit edges; above it, it leaves more and more
/// behind.
constexpr double largest_agreeing_distortion = .7;

/// A geometry that reaches further beyond the mesh that carries the metric than this
/// fraction of its extent is another domain.
constexpr double largest_gap = .25;

/// Asks the points of the geometry, not its curves: a mesh is always its own geometry.
void check_gap(const Background<2> &background, const GeometryInput &geometry) {
  Box<2> box;
  for (const Vector<2> &x : background.locator().points())
    box.extend(x);
  const double extent = (box.high - box.low).maxCoeff();
  Index cell = none;
  for (const Facet<2> &facet : geometry.facets) {
    const Vector<2> &x = geometry.points[facet[0]];
    const Location<2> at = background.locator().locate(x, cell);
    cell = at.cell;
    if (at.distance > largest_gap * extent)
      throw MeshingError(
          "the geometry reaches beyond the mesh that carries the metric, "
          "by " +
              std::to_string(at.distance / extent) + " of its extent where " +
              std::to_string(largest_gap) + " is allowed,",
          x);
  }
}

/// The user's projection, each call of which may take long.
Projection timed(const Projection &projection, Monitor &monitor) {
  if (!projection)
    return {};
  return [&](const Vector<2> &x, Index tag) {
    const Vector<2> moved = projection(x, tag);
    monitor.note_time();
    return moved;
  };
}

/// A first mesh.
struct Start {
  MeshOnCurves mesh;
  std::size_t protected_corners = 0, unprotected_corners = 0; ///< sharp ones
  bool has_unit_curves = false;
};

/// @throws BudgetSpent
Start start_on_unit_edges(Geometry &geometry, const Background<2> &background,
                          const Run &run, Stopwatch &watch) {
  Outline outline = make_outline(geometry, background, run);
  const std::size_t n_sharp = outline.n_balls + outline.n_unprotected;
  watch.phase("size");
  MeshOnCurves mesh = triangulate(geometry, background, std::move(outline),
                                  [&] { run.monitor.insist(0); });
  const std::size_t n_protected = count_balls(mesh.curve_edges);
  return {.mesh = std::move(mesh),
          .protected_corners = n_protected,
          .unprotected_corners = n_sharp - n_protected,
          .has_unit_curves = true};
}

/// On curves that are cut to unit edges or, where a budget does not allow that, at
/// points of the geometry. With the curves the phase ends.
Start make_start(Geometry &geometry, const Background<2> &background, const Run &run,
                 Stopwatch &watch) {
  try {
    return start_on_unit_edges(geometry, background, run, watch);
  } catch (const BudgetSpent &) {
    watch.phase("size");
    // the user may still interrupt this; a budget has nothing less to fall back upon
    return {.mesh = triangulate(geometry, background,
                                outline_at_points(geometry, background, run),
                                [&] { (void)run.monitor.keep_going(0, 0); })};
  }
}

/// What certify_stars needs of a mesh of triangles.
class PlaneStars {
public:
  static constexpr std::size_t d = 2;

  PlaneStars(Workspace &w, const Run &run, const QualityFloor &floor,
             const DistortionQuantiles &distortion)
      : w_(w), run_(run), floor_(floor), distortion_(distortion) {}

  [[nodiscard]] const Triangulation<2> &mesh() const { return w_.mesh; }

  [[nodiscard]] std::optional<AgreementReport>
  refusal(const RemeshSettings &settings) const {
    if (run_.is_stopped() && asks_for_stars(settings))
      // the cells of a mesh that is not refined can reach across the whole domain
      return AgreementReport{.outcome = AgreementOutcome::stopped_before,
                             .stopped_by = run_.monitor.reason()};
    if (settings.agreement == AgreementMode::off ||
        settings.consistency == ConsistencyMode::pure)
      return AgreementReport{.outcome = AgreementOutcome::off};
    if (settings.agreement == AgreementMode::when_possible &&
        distortion_.p99 > largest_agreeing_distortion)
      return varies_too_fast(99, distortion_.p99, largest_agreeing_distortion);
    return {};
  }
  AgreementCounts agree() {
    const AgreementCounts counts = anistar::agree(w_, run_);
    // the flips after a move mind no quality
    n_bisections_ += bisect(w_, run_, floor_);
    renumber(w_, run_.threads);
    return counts;
  }
  [[nodiscard]] std::size_t n_bisections() const { return n_bisections_; }
  [[nodiscard]] static bool is_certified(const RemeshSettings &settings,
                                         const AgreementReport &agreement) {
    return asks_for_stars(settings) &&
           agreement.outcome != AgreementOutcome::stopped_before;
  }
  [[nodiscard]] std::optional<DelaunayBits> certify() const {
    return certify_all(w_.mesh, run_);
  }
  [[nodiscard]] static bool is_mended(const AgreementReport &agreement) {
    return agreement.was_tried();
  }
  /// What agreement has counted stays: no more edges disagree.
  MendingCounts mend(DelaunayBits &known) {
    return {.moves = mend_stars(w_, run_, known)};
  }
  [[nodiscard]] ConsistencyCounts refine(const RemeshSettings &settings,
                                         DelaunayBits &known) {
    return refine_until_consistent(w_, run_, settings.parameters,
                                   settings.consistency != ConsistencyMode::pure,
                                   known);
  }

private:
  Workspace &w_;
  const Run &run_;
  const QualityFloor &floor_;
  const DistortionQuantiles &distortion_;
  std::size_t n_bisections_ = 0;

  [[nodiscard]] static bool asks_for_stars(const RemeshSettings &settings) {
    return settings.agreement != AgreementMode::off ||
           settings.consistency != ConsistencyMode::off;
  }
};

/// Hands the arrays of the mesh over; the workspace is spent.
void extract(Workspace &w, PlaneResult &out) {
  Triangulation<2> &mesh = w.mesh;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfFacet h(static_cast<Index>(c), i), other = mesh.opposite(h);
      if (mesh.constraint(h) == none || (other.exists() && other.cell() < h.cell()))
        continue;
      out.facets.push_back(mesh.facet(h));
      out.facet_tags.push_back(w.curve(w.curve_edge(h)).tag);
    }
  out.vertices = std::move(mesh.vertices);
  out.cells = std::move(mesh.cells);
  out.cell_tags = std::move(mesh.region);
}

/// What the curves and all passes leave for the report.
void report(Workspace &w, const Run &run, const Start &start, PlaneResult &out) {
  out.protected_corners = start.protected_corners;
  out.unprotected_corners = start.unprotected_corners;
  out.flips = w.legaliser.n_flips();
  out.capped = w.legaliser.n_capped();
  out.statistics =
      measure(w.mesh.vertices, w.mesh.cells, w.mesh.neighbours, run.threads);
  const bool is_short = !start.has_unit_curves && !run.is_stopped();
  out.reason = is_short ? StopReason::max_vertices : run.monitor.reason();
}

} // namespace

PlaneResult remesh(const Background<2> &background, const GeometryInput &input,
                   const Projection &projection, const RemeshSettings &settings,
                   Monitor::Progress progress) {
  PlaneResult out;
  Monitor monitor(std::move(progress), settings.max_vertices, settings.max_seconds);
  const Run run{.monitor = monitor,
                .hausdorff = settings.hausdorff,
                .seed = {settings.seed},
                .threads = settings.threads};
  Stopwatch watch(monitor, out.seconds);

  watch.phase("curves");
  check_gap(background, input);
  const Projection project = timed(projection, monitor);
  Geometry geometry = make_geometry(input, &project);
  Start start = make_start(geometry, background, run, watch);

  Workspace w{.on_curves = start.mesh,
              .geometry = geometry,
              .background = background,
              .hausdorff = run.hausdorff.curve};
  out.kept_quality = kept_quality<2>(background.vertices(run.threads),
                                     background.locator().cells(), run.threads);
  const QualityFloor floor{.between_walls = out.kept_quality, .elsewhere = steep_floor};
  // the pure mode starts from the boundary alone
  const bool is_pure = settings.consistency == ConsistencyMode::pure;
  if (!is_pure)
    out.refinement = refine(w, run);

  watch.phase("shape");
  renumber(w, run.threads);
  if (!is_pure)
    out.shape = shape(w, run, floor);
  renumber(w, run.threads);

  out.distortion = distortion_quantiles(w.mesh.vertices, w.mesh.cells, run.threads);
  PlaneStars stars(w, run, floor, out.distortion);
  certify_stars(stars, run, settings, watch, out);
  if (out.shape)
    out.shape->bisections += stars.n_bisections();

  watch.phase("report");
  report(w, run, start, out);
  extract(w, out);
  watch.stop();
  return out;
}

} // namespace anistar
