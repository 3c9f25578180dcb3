#include "plane/passes/quality_floor.h"

#include "base/parallel.h"

namespace anistar {
namespace {

/// The metric is steep in a cell when its densities there differ by this.
constexpr double steep_ratio = 2;

bool is_between_walls(const Triangulation<2> &mesh, const Cell<2> &cell) {
  return std::all_of(cell.begin(), cell.end(), [&](Index v) {
    return mesh.feature[v] != Triangulation<2>::interior;
  });
}

bool is_steep(const Triangulation<2> &mesh, const Cell<2> &cell) {
  const auto [low, high] =
      std::minmax({mesh.vertex(cell[0]).weight, mesh.vertex(cell[1]).weight,
                   mesh.vertex(cell[2]).weight});
  return high > steep_ratio * low;
}

} // namespace

double quality_of(const Triangulation<2> &mesh, Index cell) {
  const Cell<2> &v = mesh.at(cell);
  return quality(mesh.vertex(v[0]), mesh.vertex(v[1]), mesh.vertex(v[2]));
}

bool QualityFloor::is_met(const Triangulation<2> &mesh, Index cell) const {
  const double q = quality_of(mesh, cell);
  if (q >= std::max(between_walls, elsewhere))
    return true;
  const bool has_no_choice =
      is_between_walls(mesh, mesh.at(cell)) && !is_steep(mesh, mesh.at(cell));
  return q >= (has_no_choice ? between_walls : elsewhere);
}

std::vector<Index> poor_cells(const Triangulation<2> &mesh, const QualityFloor &floor,
                              int threads) {
  return parallel_search<Index>(mesh.cells.size(), threads,
                                [&](std::size_t k, const auto &add) {
                                  const auto c = static_cast<Index>(k);
                                  if (mesh.is_alive(c) && !floor.is_met(mesh, c))
                                    add(c);
                                });
}

} // namespace anistar
