#pragma once
// The pieces of a complex, and which of them a point belongs to.

#include "generate/checking/piece.h"
#include "generate/plc.h"

#include <span>
#include <vector>

namespace anistar::generate {

struct RepeatedPoint {
  Index first, again;
};

/// Pieces that can meet, in the order of the complex: triangles first, then segments
/// and points that are part of none.
struct Pieces {
  std::vector<Piece> pieces;
  /// Of each: the number of the triangle, segment or point in the complex.
  std::vector<Index> sources;
  std::vector<Index> same; ///< of each point: the first one of the same coordinates
  std::vector<RepeatedPoint> repeated_points;
  std::vector<Index> degenerate_triangles; ///< all corners on one line
  std::vector<Index> empty_segments;       ///< of length zero

  [[nodiscard]] Piece of(std::span<const Index> points) const;
};

[[nodiscard]] Pieces pieces_of(const Plc &plc, std::span<const Index> points_kept);

/// The pieces around every point.
class Surroundings {
public:
  Surroundings(std::span<const Piece> pieces, std::size_t n_points);
  [[nodiscard]] std::span<const Index> of(Index point) const {
    return {around_.data() + begin_[point],
            static_cast<std::size_t>(begin_[point + 1] - begin_[point])};
  }

private:
  std::vector<Index> begin_, around_;
};

} // namespace anistar::generate
