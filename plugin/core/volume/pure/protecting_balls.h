#pragma once
// Ridges divided into edges of about unit length, and their protecting balls (RR-7712,
// section 7.2, after Cheng, Dey, Levine).
//
// Every point of the division may get a ball in its own metric: those of neighbours
// overlap and no other two do. In the star set the balls are weights: no site outside
// of them can part two neighbours.

#include "base/run.h"
#include "volume/pure/domain_oracle.h"
#include "volume/pure/site.h"

namespace anistar {

/// Sites on the ridges and at the corners, and the edges between them.
struct DividedRidges {
  std::vector<Site> sites;
  std::vector<RidgeEdge> edges; ///< their ends are sites
};

/// Without balls.
/// @param start the input mesh on its surfaces and ridges
/// @throws BudgetSpent when the time is up, or the metric asks for more sites than
/// there may be vertices, before any is made
[[nodiscard]] DividedRidges divided_ridges(const Volume &start, const Run &run);
/// With balls, unless these are more than some thousands: they are compared with one
/// another. Where some do not fit after many divisions, they stay as they are.
/// @throws BudgetSpent as above
[[nodiscard]] DividedRidges protected_ridges(const Volume &start, const Run &run);

} // namespace anistar
