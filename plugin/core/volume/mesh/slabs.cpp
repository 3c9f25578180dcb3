#include "volume/mesh/slabs.h"

#include <algorithm>
#include <limits>

namespace anistar {
namespace {

/// A slab is as thick as that many cells, and has that many vertices: near its sides
/// the cells around a vertex are not all inside.
constexpr double cells_across = 6;
constexpr std::size_t fewest_vertices = 4096;
constexpr std::size_t most_slabs = 32;
/// Figures are taken from samples of about this many vertices and cells.
constexpr std::size_t sample_size = 2048;
/// Cuts at which the cells of an axis are counted.
constexpr std::size_t n_trial_cuts = 15;

/// Coordinates along an axis, sorted.
std::vector<double> sample(const Triangulation<3> &mesh, int axis) {
  const std::size_t step = std::max<std::size_t>(1, mesh.vertices.size() / sample_size);
  std::vector<double> x;
  for (std::size_t v = 0; v < mesh.vertices.size(); v += step)
    x.push_back(mesh.vertices[v].x[axis]);
  std::sort(x.begin(), x.end());
  return x;
}

/// The places that cut sorted coordinates into n equal parts.
std::vector<double> quantiles(const std::vector<double> &x, std::size_t n) {
  std::vector<double> cuts;
  for (std::size_t k = 1; k < n; ++k)
    cuts.push_back(x[x.size() * k / n]);
  return cuts;
}

/// The number of cuts below x.
std::ptrdiff_t part(const std::vector<double> &cuts, double x) {
  return std::upper_bound(cuts.begin(), cuts.end(), x) - cuts.begin();
}

/// The share of the cells that lie across a cut, in the mean of all cuts.
double crossing(const Triangulation<3> &mesh, int axis,
                const std::vector<double> &cuts) {
  const std::size_t step = std::max<std::size_t>(1, mesh.cells.size() / sample_size);
  std::ptrdiff_t n = 0, crossed = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); c += step, ++n) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (Index v : mesh.cells[c]) {
      low = std::min(low, mesh.vertex(v).x[axis]);
      high = std::max(high, mesh.vertex(v).x[axis]);
    }
    crossed += part(cuts, high) - part(cuts, low);
  }
  return static_cast<double>(crossed) / static_cast<double>(n) /
         static_cast<double>(cuts.size());
}

} // namespace

std::size_t Slabs::of_cell(const Cell<3> &cell, int round) const {
  if (cell[0] == none)
    return nowhere;
  const std::size_t k = of_vertex(cell[0], round);
  return of_vertex(cell[1], round) == k && of_vertex(cell[2], round) == k &&
                 of_vertex(cell[3], round) == k
             ? k
             : nowhere;
}

void Slabs::add_vertex(Index v) {
  if (std::cmp_equal(v, strip.size())) {
    strip.push_back(0);
    border.push_back(0);
  }
  border[v] = 0;
}

void Slabs::add_cell_on_strips(const Cell<3> &cell) {
  for (int round = 0; round < n_rounds; ++round)
    if (of_cell(cell, round) == nowhere)
      for (Index v : cell) {
        std::uint8_t &bits = border[v];
        bits = static_cast<std::uint8_t>(bits | 1u << round);
      }
}

Slabs cut_into_slabs(const Triangulation<3> &mesh) {
  const std::size_t n_vertices = mesh.vertices.size();
  Slabs slabs;
  slabs.strip.assign(n_vertices, 0);
  slabs.border.assign(n_vertices, 0);
  if (n_vertices < 2 * fewest_vertices)
    return slabs;
  std::vector<double> x;
  double least = 1;
  int best = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> along = sample(mesh, axis);
    const double share = crossing(mesh, axis, quantiles(along, n_trial_cuts + 1));
    if (axis == 0 || share < least) {
      x = std::move(along);
      least = share;
      best = axis;
    }
  }
  const double n = 1 / (cells_across * std::max(least, 1e-3));
  slabs.n = std::clamp(static_cast<std::size_t>(n), std::size_t{1},
                       std::min(most_slabs, n_vertices / fewest_vertices));
  if (slabs.n == 1)
    return slabs;
  const std::vector<double> cuts = quantiles(x, 2 * slabs.n);
  for (std::size_t v = 0; v < n_vertices; ++v)
    slabs.strip[v] = static_cast<std::uint16_t>(part(cuts, mesh.vertices[v].x[best]));
  for (const Cell<3> &cell : mesh.cells)
    slabs.add_cell(cell);
  return slabs;
}

} // namespace anistar
