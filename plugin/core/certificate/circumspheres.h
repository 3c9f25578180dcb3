#pragma once
// What the circumspheres of the cells say of them, in the metrics of their vertices:
// radius-edge ratios, sliverities, and the restricted stars of the paper.

#include "certificate/certificate.h"

namespace anistar {

/// Of every cell, the worst that the metric of one of its vertices makes of it.
struct CellShapes {
  PerCell<double> radius_edge; ///< largest r / e, with the shortest edge e
  PerCell<double> sliverity;   ///< smallest (Vol / e^d)^(1/d)
};

/// Cells, and how many of them are in the restricted stars of all their vertices.
struct RestrictedCount {
  std::size_t ok = 0, of = 0;

  RestrictedCount &operator+=(const RestrictedCount &other) {
    ok += other.ok;
    of += other.of;
    return *this;
  }
};

/// Of the cells whose circumcentre lies in the domain.
struct RestrictedStars {
  RestrictedCount v1; ///< for the metrics of all vertices (RR-7712 v1, section 3)
  RestrictedCount v2; ///< for that of one at least (RR-7712 v2, section 3)
};

struct CircumsphereFigures {
  CellShapes shapes;
  RestrictedStars restricted;
};

/// @param bits see DelaunayBits
template <std::size_t d>
[[nodiscard]] CircumsphereFigures
circumsphere_figures(CertifiedMesh<d> mesh, std::span<const std::uint8_t> bits,
                     int threads, const Look &look);

} // namespace anistar
