#pragma once
// Normals and curvatures at the vertices of triangulated surfaces.

#include "surface/surface_features.h"

namespace anistar {

/// What a smooth surface does at one of its vertices, from a polynomial of degree up to
/// three over the tangent plane that fits the vertices around (Cazals and Pouget,
/// Estimating differential quantities using polynomial fitting of osculating jets,
/// 2005). Differs from theirs in a term with the square of the height, found by fitting
/// again, which makes it exact on spheres and cylinders, at the edge of a patch as well
/// as inside.
struct Jet {
  Vector<3> normal = Vector<3>::Zero();
  SymmetricTensor<3> curvature; ///< principal curvatures with their directions
};

/// The jets of a surface; a vertex of a ridge has one for each side of it.
struct Jets {
  std::vector<Jet> jets;
  std::vector<Index> vertex;        ///< of every jet
  std::vector<Facet<3>> facet_jets; ///< at the corners of every facet
};

[[nodiscard]] Jets fit_jets(std::span<const Vector<3>> points,
                            std::span<const Facet<3>> facets, const Features &features);

} // namespace anistar
