#pragma once
// The sites that the star set begins with.

#include "volume/mesh/volume.h"
#include "volume/pure/site.h"

namespace anistar {

/// The corners where no ridge ends, and a few points, far from one another, of every
/// surface that has no ridge. The paper asks for three or more on each.
[[nodiscard]] std::vector<Site> surface_sites(const Volume &start);

} // namespace anistar
