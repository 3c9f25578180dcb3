#include "generate/constrained/flat/volume_points.h"

#include <algorithm>

namespace anistar::generate {
namespace {

/// Shapes that all cells at a point should have: the first that is in reach will do.
constexpr double wanted_shapes[] = {1e-2, 1e-3, 1e-5, 1e-8};
/// How far from the middle of the edge to the vertex a point is placed.
constexpr double shares[] = {.5, .25, .75};

} // namespace

std::optional<Swap> VolumePoints::star_in_place_of(Index c) {
  for (const double shape : wanted_shapes)
    if (const auto place = best_place(c, shape)) {
      auto star = ball_.about(c, put(*place), shape);
      mesh_.add_vertex(); // the middle
      mesh_.add_vertex();
      return star;
    }
  return std::nullopt;
}

std::optional<VolumePoints::Place> VolumePoints::best_place(Index c,
                                                            double least_shape) {
  const Cell<3> cell = mesh_.cell(c);
  const std::vector<Index> targets = vertices_beside(c);
  std::optional<Place> best;
  double best_shape = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      for (const Index towards : targets)
        for (const double t : shares) {
          const Place place{cell[i], cell[j], towards, t};
          const auto star = ball_.about(c, put(place), least_shape);
          if (star && is_worth(*star) && star->least_after > best_shape) {
            best_shape = star->least_after;
            best = place;
          }
          withdraw();
        }
  return best;
}

/// The vertices of the cells beside those that share a facet with a cell.
std::vector<Index> VolumePoints::vertices_beside(Index c) const {
  std::vector<Index> found;
  for (std::size_t i = 0; i < 4; ++i) {
    const Index beside = mesh_.opposite({c, i}).cell();
    for (std::size_t j = 0; j < 4; ++j)
      found.push_back(mesh_.apex(mesh_.opposite({beside, j})));
    found.push_back(mesh_.apex(mesh_.opposite({c, i})));
  }
  std::ranges::sort(found);
  const auto rest = std::ranges::unique(found);
  found.erase(rest.begin(), rest.end());
  std::erase_if(found, [&](Index v) { return v == ghost || mesh_.index_of(c, v); });
  return found;
}

Index VolumePoints::put(const Place &place) {
  const Index middle = points_.add({place.from, place.to, .5});
  return points_.add({middle, place.towards, place.t});
}

void VolumePoints::withdraw() {
  points_.remove_last();
  points_.remove_last();
}

} // namespace anistar::generate
