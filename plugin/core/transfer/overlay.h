#pragma once
// Two meshes of one domain laid over each other: which cells overlap, and by how much.

#include "search/locator.h"
#include "transfer/intersection.h"

#include <span>
#include <vector>

namespace anistar {

/// A cell may stay uncovered by this part of its volume before it counts as uncovered:
/// barycentric coordinates lose a digit for each factor ten of a cell's aspect ratio,
/// so that clipping is good to about 1e-10 at an aspect ratio of 1e6.
inline constexpr double coverage_round_off = 1e-9;

template <std::size_t d> struct Overlap {
  Index source;
  Moments<d> moments;
  double volume; ///< of the intersection
};

/// How one target cell is covered. The moments sum to those of the cell itself, so that
/// constants are kept to round-off: what the source leaves uncovered is given to the
/// source point nearest to the centroid of the gap.
template <std::size_t d> struct Cover {
  std::vector<Overlap<d>> overlaps; ///< by source cell, ascending; the fill is last
  double uncovered = 0;             ///< volume, beyond round-off
  double distance = 0;              ///< from the centroid of the gap to the source
  bool filled = false;              ///< the last overlap is no overlap but the fill
};

/// Finds the source cells that overlap a target cell. Not safe for concurrent use; each
/// thread has its own, on one locator.
template <std::size_t d> class Overlay {
public:
  explicit Overlay(const Locator<d> &source);

  /// By an advancing front from the source cell that holds the centroid; where that
  /// leaves a gap, by the box tree.
  /// @pre positive volume.
  [[nodiscard]] const Cover<d> &cover(const Simplex<d> &target);

  /// Forgets the cell where the last walk ended, so that what follows is the same
  /// whatever came before.
  void restart() { hint_ = none; }

private:
  const Locator<d> *source_;
  Cover<d> cover_;
  std::vector<Index> seen_; ///< the visit in which a source cell was tried last
  std::vector<Index> front_;
  Index visit_ = 0;
  Index hint_ = none;

  void advance(const Simplex<d> &target, const Box<d> &box, double volume);
  bool try_cell(const Simplex<d> &target, const Box<d> &box, double volume, Index cell,
                bool spread);
  [[nodiscard]] std::array<double, d + 1> gap(double volume) const;
  void close_gap(const Simplex<d> &target, double volume);
};

} // namespace anistar
