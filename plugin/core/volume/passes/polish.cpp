// The last touch: moves and swaps for the quality that reports take, in the metric of
// the densest corner. The passes before it improve the quality in the mean of the four
// metrics; the two differ where the metric varies much within a cell.

#include "volume/passes/passes.h"

namespace anistar {
namespace {

/// A star is worth the sum of its qualities less this many times what its cells miss
/// below `poor_quality`.
constexpr double poor_weight = 4, poor_quality = .55;
/// What a step must add to be taken.
constexpr double smallest_gain = .006;
/// Steps in the metric, halved from the first to the last.
constexpr double longest_step = .16, shortest_step = .03;
/// A star whose mean quality is above is left alone.
constexpr double good_mean = .9;
/// Swaps for cells below, and what they must gain.
constexpr double swapped_below = .7, swap_gain = 1e-3;
/// What the mean of the metrics may say of a cell that a swap makes.
constexpr double mean_floor = .05;
constexpr std::size_t longest_ring = 9;
/// The metric is steep when the densities within a cell differ by this at the median.
constexpr double steep_ratio = 1.5;

/// The mean of the metrics is rarely this much kinder to a cell than the densest.
constexpr double largest_difference = .3;

double measured(const Triangulation<3> &mesh, const Cell<3> &cell) {
  return quality(mesh.vertex(cell[0]), mesh.vertex(cell[1]), mesh.vertex(cell[2]),
                 mesh.vertex(cell[3]));
}

} // namespace

bool VolumePasses::is_metric_steep() const {
  const Triangulation<3> &mesh = volume_.mesh;
  std::size_t n = 0, n_steep = 0;
  for (const Cell<3> &cell : mesh.cells) {
    if (cell[0] == none)
      continue;
    double low = mesh.vertex(cell[0]).weight, high = low;
    for (Index v : cell) {
      low = std::min(low, mesh.vertex(v).weight);
      high = std::max(high, mesh.vertex(v).weight);
    }
    ++n;
    n_steep += high > steep_ratio * low;
  }
  return 2 * n_steep > n;
}

void VolumePasses::polish(double below) {
  polish_vertices(below);
  polish_cells(std::min(below, swapped_below));
}

void VolumePasses::polish_vertices(double below) {
  const std::uint32_t since = begin(Pass::polish);
  const Triangulation<3> &mesh = volume_.mesh;
  const std::size_t n = mesh.vertices.size();
  std::vector<std::uint8_t> is_wanted(n, 0);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    if (mesh.cells[c][0] != none && volume_.cell_clock[c] >= since &&
        volume_.quality_of(static_cast<Index>(c)) < below + largest_difference &&
        measured(mesh, mesh.cells[c]) < below)
      for (Index v : mesh.cells[c])
        is_wanted[v] = 1;
  for (std::size_t k = 0; k < n && go_on(k, n); ++k) {
    if (is_wanted[k] == 0 || mesh.feature[k] == Triangulation<3>::corner)
      continue;
    const auto v = static_cast<Index>(k);
    star_of(volume_, v, star_);
    if (polish_vertex(v))
      ++counts_.moves;
  }
}

/// Tries steps along the axes of the metric, as long as the star is worth more.
/// @pre star_ is the star of v.
bool VolumePasses::polish_vertex(Index v) {
  const Triangulation<3> &mesh = volume_.mesh;
  if (star_.size() >= DensestShapes::capacity || !trial_.gather(v, star_))
    return false;
  densest_.clear();
  for (Index c : star_) {
    const Facet<3> t = facet_of<3>(mesh.at(c), mesh.local_index(c, v));
    densest_.add(mesh.vertex(t[0]), mesh.vertex(t[1]), mesh.vertex(t[2]));
  }
  densest_.evaluate(mesh.vertex(v), poor_quality);
  if (densest_.sum() > good_mean * static_cast<double>(star_.size()))
    return false;
  const double floor = std::min(densest_.minimum(), poor_quality);
  double worth = densest_.sum() - poor_weight * densest_.missing();
  bool has_moved = false;
  const Matrix<3> axes = lower_factor<3>(mesh.vertex(v).M).transpose().inverse();
  for (double length = longest_step; length > shortest_step; length /= 2)
    for (int k = 0; k < 3; ++k) {
      const Vector<3> step = length * axes.col(k), &here = mesh.vertex(v).x;
      if (polish_step(here + step, floor, worth) ||
          polish_step(here - step, floor, worth))
        has_moved = true;
    }
  return has_moved;
}

/// Moves the vertex of the trial there when its star is worth more then.
bool VolumePasses::polish_step(const Vector<3> &x, double floor, double &worth) {
  trial_.place(x);
  if (!trial_.is_positive() || !trial_.keeps_surfaces())
    return false;
  trial_.take_metric();
  densest_.evaluate(trial_.vertex(), poor_quality);
  const double value = densest_.sum() - poor_weight * densest_.missing();
  if (value < worth + smallest_gain || densest_.minimum() < floor ||
      densest_.minimum() <= 0)
    return false;
  worth = value;
  (void)trial_.measure();
  trial_.commit();
  return true;
}

void VolumePasses::polish_cells(double below) {
  const Triangulation<3> &mesh = volume_.mesh;
  const std::size_t n = mesh.cells.size();
  for (std::size_t k = 0; k < n && go_on(k, n); ++k) {
    const auto c = static_cast<Index>(k);
    if (!mesh.is_alive(c) || volume_.quality_of(c) >= below + largest_difference ||
        measured(mesh, mesh.at(c)) >= below)
      continue;
    const Cell<3> cell = mesh.at(c);
    bool is_done = false;
    for (std::size_t i = 0; i < 4 && !is_done; ++i)
      for (std::size_t j = i + 1; j < 4 && !is_done; ++j)
        is_done = polish_edge(c, cell[i], cell[j]);
    for (std::size_t i = 0; i < 4 && !is_done; ++i)
      is_done = polish_facet(HalfFacet(c, i));
  }
}

/// Removes an edge where that improves the worst cell around it.
bool VolumePasses::polish_edge(Index c, Index a, Index b) {
  const Triangulation<3> &mesh = volume_.mesh;
  const auto walls = walls_of_removable(volume_, c, a, b, longest_ring, shell_);
  if (!walls)
    return false;
  double worst = 1;
  for (Index cell : shell_.all())
    worst = std::min(worst, measured(mesh, mesh.at(cell)));
  for (std::size_t k = 0; k < shell_.n_ring(); ++k) {
    if (!walls->admits_apex(k))
      continue;
    if (ring_quality(k, worst + swap_gain) > worst + swap_gain &&
        operator_.replace(shell_.all(), shell_.ring[k], {a, b},
                          {mean_floor, swap_gain, 0, run_.hausdorff.surface})) {
      ++counts_.edge_swaps;
      return true;
    }
  }
  return false;
}

/// The worst cell when the ring of the shell is joined to one of its vertices, or
/// something below `threshold`.
double VolumePasses::ring_quality(std::size_t apex, double threshold) const {
  const std::size_t n = shell_.n_ring();
  const Index r = shell_.ring[apex];
  double least = 1;
  for (std::size_t k = 1; k + 1 < n && least > threshold; ++k) {
    const std::size_t i = (apex + k) % n, j = (apex + k + 1) % n;
    if (!shell_.is_closed && j == 0)
      continue; // an open ring has a gap there
    const Index u = shell_.ring[i], w = shell_.ring[j];
    least = std::min({least, measured(volume_.mesh, {shell_.a, r, u, w}),
                      measured(volume_.mesh, {r, shell_.b, u, w})});
  }
  return least;
}

/// Replaces a facet between two cells by the edge between their apices.
bool VolumePasses::polish_facet(HalfFacet h) {
  const Triangulation<3> &mesh = volume_.mesh;
  const HalfFacet beyond = mesh.opposite(h);
  if (!beyond.exists() || mesh.constraint(h) != none)
    return false;
  const Facet<3> t = mesh.facet(h);
  const Index p = mesh.at(h.cell())[h.facet()],
              q = mesh.at(beyond.cell())[beyond.facet()];
  const double worst = std::min(measured(mesh, mesh.at(h.cell())),
                                measured(mesh, mesh.at(beyond.cell())));
  for (std::size_t k = 0; k < 3; ++k)
    if (measured(mesh, {t[k], t[(k + 1) % 3], q, p}) < worst + swap_gain)
      return false;
  const std::array<Index, 2> both{h.cell(), beyond.cell()};
  if (!operator_.replace(both, p, {none, none}, {mean_floor, swap_gain}))
    return false;
  ++counts_.face_swaps;
  return true;
}

} // namespace anistar
