#include "base/parallel.h"
#include "volume/passes/passes.h"

namespace anistar {
namespace {

/// The six edges of a cell.
constexpr std::size_t cell_edges[6][2] = {{0, 1}, {0, 2}, {0, 3},
                                          {1, 2}, {1, 3}, {2, 3}};

/// A new vertex stands where the two halves have equal length when the size grows
/// geometrically along the edge, but not too near an end.
constexpr double nearest_to_end = .375;

/// Edges beyond this length are split even when the new vertex comes nearer to others
/// than the rule says.
constexpr double very_long = 3, relaxed = .4;

/// Halves of an edge of a smooth curve leave it by a quarter of what the edge does.
constexpr double nearer = .4;

/// A facet is hidden from a vertex that would make a cell below this quality with it.
constexpr double hidden = 1e-5;

} // namespace

std::uint32_t VolumePasses::begin(Pass pass) {
  std::uint32_t &last = last_[static_cast<std::size_t>(pass)];
  const std::uint32_t since = last;
  last = ++volume_.clock;
  return since;
}

bool VolumePasses::go_on(std::size_t k, std::size_t n) {
  return run_.monitor.keep_going(0, static_cast<double>(k) / static_cast<double>(n));
}

double VolumePasses::longest_edge() const {
  double longest = 0;
  for (std::size_t c = 0; c < volume_.mesh.cells.size(); ++c)
    if (volume_.mesh.is_alive(static_cast<Index>(c)))
      longest = longest_edge(static_cast<Index>(c), longest).length;
  return longest;
}

/// The longest edge of a cell that is longer than a bound.
VolumePasses::LongEdge VolumePasses::longest_edge(Index c, double above) const {
  const Triangulation<3> &mesh = volume_.mesh;
  LongEdge found{none, none, above};
  for (const auto &[i, j] : cell_edges) {
    const Index u = mesh.at(c)[i], w = mesh.at(c)[j];
    const Vertex<3> &p = mesh.vertex(u), &q = mesh.vertex(w);
    const Vector<3> e = q.x - p.x;
    const double square = found.length * found.length;
    // a mean is not above both
    if (quadratic<3>(p.M, e) <= square && quadratic<3>(q.M, e) <= square)
      continue;
    const double l = fast_length(p, q);
    if (l > found.length)
      found = {u, w, l};
  }
  return found;
}

/// Whether a cell that changed since then may have something to split.
std::vector<std::uint8_t> VolumePasses::due_cells(double above,
                                                  std::uint32_t since) const {
  std::vector<std::uint8_t> due(volume_.mesh.cells.size(), 0);
  parallel_ranges(due.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto c = static_cast<Index>(k);
      due[k] = volume_.mesh.is_alive(c) && volume_.cell_clock[k] >= since &&
               (volume_.is_walled(c) || longest_edge(c, above).a != none);
    }
  });
  return due;
}

std::size_t VolumePasses::split(const SplitRule &rule) {
  const std::uint32_t since = begin(Pass::split);
  const Triangulation<3> &mesh = volume_.mesh;
  const std::vector<std::uint8_t> due = due_cells(rule.longest, since);
  const std::size_t n = due.size();
  std::size_t done = 0;
  for (std::size_t k = 0; k < n && go_on(k, n); ++k) {
    const auto c = static_cast<Index>(k);
    const bool is_new = volume_.cell_clock[k] == volume_.clock; // made by this pass
    if ((due[k] == 0 && !is_new) || !mesh.is_alive(c))
      continue;
    const auto [a, b, length] = longest_edge(c, rule.longest);
    if (a == none) {
      done += volume_.is_walled(c) && split_curved(c);
      continue;
    }
    SplitRule local = rule;
    if (length > very_long)
      local.closest *= relaxed;
    done += split_edge(c, a, b, local, {rule.floor, 1e-4, 0, 0, rule.share});
  }
  counts_.splits += done;
  return done;
}

bool VolumePasses::is_off_curve(Index curve, const Vertex<3> &a,
                                const Vertex<3> &b) const {
  return volume_.surface.strays(1, curve, a, b, run_.hausdorff.curve);
}

std::size_t VolumePasses::follow_surfaces() {
  const Triangulation<3> &mesh = volume_.mesh;
  const std::size_t n = mesh.cells.size();
  std::size_t done = 0;
  for (std::size_t k = 0; k < n && go_on(k, n); ++k) {
    const auto c = static_cast<Index>(k);
    done += mesh.is_alive(c) && volume_.is_walled(c) && split_curved(c);
  }
  counts_.splits += done;
  return done;
}

/// Whether halves follow a feature better: on what is no smooth feature at all they do
/// not, and splitting would have no end.
bool VolumePasses::comes_nearer(Index dimension, Index lies_on, const Vector<3> &a,
                                const Vector<3> &x, const Vector<3> &b) const {
  const double whole = volume_.surface.lift(dimension, lies_on, a, b).norm();
  return volume_.surface.lift(dimension, lies_on, a, x).norm() < nearer * whole &&
         volume_.surface.lift(dimension, lies_on, x, b).norm() < nearer * whole;
}

/// Splits the longest edge of a cell that strays from the curved feature it lies on.
bool VolumePasses::split_curved(Index c) {
  const Triangulation<3> &mesh = volume_.mesh;
  Index a = none, b = none;
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Index patch = mesh.constraint(HalfFacet(c, i));
    if (patch == none)
      continue;
    const Facet<3> t = facet_of<3>(mesh.at(c), i);
    for (std::size_t k = 0; k < 3; ++k) {
      const Index u = t[k], w = t[(k + 1) % 3];
      const Vertex<3> &p = mesh.vertex(u), &q = mesh.vertex(w);
      const double square = (q.x - p.x).squaredNorm();
      if (square <= longest)
        continue;
      const Index ridge = volume_.feature(u) <= 1 && volume_.feature(w) <= 1
                              ? volume_.ridges.find(u, w)
                              : none;
      if (ridge != none ? is_off_curve(volume_.ridges.at(ridge).curve, p, q)
                        : volume_.surface.strays(2, patch, p, q, run_.hausdorff.surface)) {
        longest = square;
        a = u;
        b = w;
      }
    }
  }
  return a != none && split_edge(c, a, b, {0, 0, 0, 0, true}, {1e-4, 1e-4, 0, 0, .1});
}

/// Collects the cells of the shell in star_, and those that hide their facets from v:
/// on a curved surface v may be off the cells of the edge that it splits.
bool VolumePasses::widen_shell(Index v) {
  const Triangulation<3> &mesh = volume_.mesh;
  star_.assign(shell_.all().begin(), shell_.all().end());
  volume_.open_cells();
  for (Index c : star_)
    volume_.mark_cell(c);
  for (std::size_t i = 0; i < star_.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      const HalfFacet h(star_[i], k), beyond = mesh.opposite(h);
      const Facet<3> t = mesh.facet(h);
      const bool is_cut = std::count_if(t.begin(), t.end(), [&](Index u) {
                            return u == shell_.a || u == shell_.b;
                          }) == 2;
      if (is_cut || (beyond.exists() && volume_.is_marked_cell(beyond.cell())) ||
          shape_quality(mesh.vertex(t[0]), mesh.vertex(t[1]), mesh.vertex(t[2]),
                        mesh.vertex(v)) > hidden)
        continue;
      if (!beyond.exists() || mesh.constraint(h) != none ||
          star_.size() == Shell::capacity || has_ridge(volume_, mesh.at(beyond.cell())))
        return false;
      volume_.mark_cell(beyond.cell());
      star_.push_back(beyond.cell());
    }
  return star_.size() > shell_.n_cells;
}

Index VolumePasses::new_vertex(const Vector<3> &x, Index dimension, Index lies_on) {
  // the hint is that of the last vertex of the shell, which is near
  Index at = volume_.mesh.background_cell[shell_.a];
  const Vertex<3> vertex = volume_.background.vertex(x, at);
  const Index v = volume_.add_vertex(vertex, dimension, lies_on, at);
  std::vector<std::uint16_t> &strip = volume_.state.slabs.strip;
  strip[v] = strip[shell_.a];
  return v;
}

bool VolumePasses::split_edge(Index cell, Index a, Index b, const SplitRule &rule,
                              const Acceptance &acceptance) {
  if (!run_.monitor.has_room(volume_.n_vertices())) {
    is_full_ = true;
    return false;
  }
  if (!shell_of(volume_.mesh, cell, a, b, shell_))
    return false;
  const EdgeFeature feature = feature_of(volume_, shell_);
  if (feature.is_frozen)
    return false;
  const Index dimension = feature.dimension, lies_on = feature.lies_on;
  const Vertex<3> &p = volume_.mesh.vertex(a), &q = volume_.mesh.vertex(b);
  const Vector<3> e = q.x - p.x;
  const double la = std::sqrt(quadratic<3>(p.M, e)),
               lb = std::sqrt(quadratic<3>(q.M, e));
  const double s =
      std::clamp(.5 * (.5 + lb / (la + lb)), nearest_to_end, 1 - nearest_to_end);
  const Vector<3> x = volume_.surface.place(dimension, lies_on, p.x + s * e);
  if (rule.follows_curve && !comes_nearer(dimension, lies_on, p.x, x, q.x))
    return false;
  const Index v = new_vertex(x, dimension, lies_on); // p and q are no more
  bool is_clear = true;
  if (rule.closest > 0)
    for (std::size_t k = 0; k < shell_.n_ring() && is_clear; ++k)
      is_clear = fast_length(volume_.mesh.vertex(shell_.ring[k]),
                             volume_.mesh.vertex(v)) >= rule.closest;
  const bool is_curved = !volume_.surface.is_flat(dimension, lies_on);
  if (!is_clear || !(operator_.replace(shell_.all(), v, {a, b}, acceptance) ||
                     (is_curved && widen_shell(v) &&
                      operator_.replace(star_, v, {a, b}, acceptance)))) {
    volume_.remove_vertex(v);
    return false;
  }
  if (feature.ridge != none)
    volume_.ridges.split(a, b, v);
  return true;
}

} // namespace anistar
