#include "surface/facet_bulges.h"

#include "surface/jets.h"

#include <algorithm>

namespace anistar {

std::vector<FacetBulge<3>> facet_bulges(const SurfaceInput &input) {
  std::vector<FacetBulge<3>> bulges(input.facets.size(), FacetBulge<3>{});
  const Features features = find_features(input);
  const auto is_planar = [](const Patch &patch) { return patch.is_planar; };
  if (std::all_of(features.patches.begin(), features.patches.end(), is_planar))
    return bulges;
  const Jets jets = fit_jets(input.points, input.facets, features);
  for (std::size_t f = 0; f < bulges.size(); ++f) {
    if (is_planar(features.patches[features.facet_patch[f]]))
      continue;
    std::array<Vector<3>, 3> corners, normals;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = input.points[input.facets[f][k]];
      normals[k] = jets.jets[jets.facet_jets[f][k]].normal;
    }
    bulges[f] = facet_bulge<3>(corners, normals);
  }
  return bulges;
}

} // namespace anistar
