#pragma once
// Smoothing: every vertex is drawn to where its star has better shapes.

#include "base/run.h"
#include "plane/mesh/workspace.h"

namespace anistar {

/// Where a vertex is drawn to.
enum class Target {
  unit_edges, ///< Bossen and Heckbert, A pliant method for anisotropic mesh generation
  odt         ///< optimal Delaunay triangulation: the mean of the circumcentres
};

/// One sweep over all vertices: each moves towards its target as far as its star stays
/// valid, takes the metric of its new place, and its edges are legalised. Vertices on a
/// curve slide along it.
///
/// Blocks are swept side by side, see mesh/blocks.h. Vertices on curves wait for the
/// end: they must not run into another part of the boundary.
void smooth(Workspace &w, const Run &run, Target target);

} // namespace anistar
