#pragma once
// Triangles cut where they meet others.

#include "base/monitor.h"
#include "generate/repair/triangle_soup.h"

#include <span>

namespace anistar::generate {

/// The triangles, those that meet others beyond shared points and edges cut along what
/// they have in common. The cuts are exact, the points are rounded at the end: what was
/// cut may cross again, by round-off. What is repeated, or has no area, is left out.
/// Given points come first.
/// @throws BudgetSpent when the monitor stops it.
[[nodiscard]] TriangleSoup arrangement_of(std::span<const Vector<3>> points,
                                          std::span<const Facet<3>> triangles,
                                          Monitor &monitor);

} // namespace anistar::generate
