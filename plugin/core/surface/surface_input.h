#pragma once
// The surfaces and ridges of a mesh, as they are given and as they are told apart.

#include "base/tensor.h"
#include "mesh/adjacency.h"
#include "remesh/domain_shape.h"

#include <span>

namespace anistar {

/// The surfaces and edges that bound or cross a domain.
struct SurfaceInput {
  std::span<const Vector<3>> points;
  std::span<const Facet<3>> facets;
  std::span<const Index> facet_tags;
  std::span<const std::array<Index, 2>> edges;
  std::span<const Index> edge_tags;
  std::span<const Index> corners;
  DomainShape shape;
};

/// A smooth piece of surface with one tag.
struct Patch {
  Index tag = 0;
  bool is_planar = false;
  bool is_frozen = false;
  Vector<3> origin = Vector<3>::Zero(), normal = Vector<3>::Zero(); ///< of its plane
};

/// A smooth piece of ridge between two corners, or a closed one.
struct SurfaceCurve {
  Index tag = 0;
  bool is_given = false; ///< it has a tag; else an angle or a change of tags made it
  bool is_straight = false;
  bool is_frozen = false; ///< bodies only touch along it
  Vector<3> origin = Vector<3>::Zero(), direction = Vector<3>::Zero(); ///< of its line
};

} // namespace anistar
