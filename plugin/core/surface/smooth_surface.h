#pragma once
// Smooth surfaces and ridges through the points of a geometry.
//
// A piece of it, a triangle or a segment, is displaced by a cubic that vanishes at its
// corners: along every edge it is the cubic Hermite curve whose tangents lie in the
// tangent planes of its ends, with the magnitude that follows a circle to sixth order;
// inside, it reproduces quadratics (Vlachos, Peters, Boyd, Mitchell, Curved PN
// triangles, 2001). Neighbouring triangles meet continuously along the curve of their
// edge; ridges are the curves of their edges. Flat pieces stay exactly flat.

#include "search/box_tree.h"
#include "surface/jets.h"
#include "surface/ridge_chains.h"
#include "surface/surface_features.h"

#include <limits>
#include <optional>

namespace anistar {

/// A triangle, or a segment whose third corner repeats the second.
struct CurvedPiece {
  std::array<Vector<3>, 3> corners;
  /// [i][j]: of the control point next to corner i on the edge to corner j.
  std::array<std::array<Vector<3>, 3>, 3> offsets;
  Index feature = none; ///< the patch or curve of the geometry that it is part of

  [[nodiscard]] bool is_flat() const;
  [[nodiscard]] Vector<3> displacement(const std::array<double, 3> &weights) const;
  [[nodiscard]] Vector<3> chordal(const std::array<double, 3> &weights) const;
  /// Of the curved triangle, not normalised.
  [[nodiscard]] Vector<3> normal(const std::array<double, 3> &weights) const;
};

/// Which patches, or curves, of a geometry count; all when it is empty.
using FeatureSet = std::vector<std::uint8_t>;

/// Pieces among which the place of a point is looked for.
class CurvedPieces {
public:
  explicit CurvedPieces(std::vector<CurvedPiece> pieces);

  struct Foot {
    Vector<3> x; ///< on the smooth surface or ridge
    Vector<3> normal;
  };
  /// The foot of x: the point in whose normal direction x lies, to the accuracy of a
  /// few rounds. @pre there are pieces.
  [[nodiscard]] Foot project(const Vector<3> &x, const FeatureSet &among = {}) const;
  /// Whether some piece is part of one of these.
  [[nodiscard]] bool has_any(const FeatureSet &among) const;
  /// The patch or curve of the piece nearest to x.
  [[nodiscard]] Index nearest_feature(const Vector<3> &x) const;
  [[nodiscard]] const CurvedPiece &piece(std::size_t k) const { return pieces_[k]; }

  struct Place {
    Index piece;
    std::array<double, 3> weights;
  };
  /// Where on a piece x lies, if it is no farther from it than this.
  [[nodiscard]] std::optional<Place> find(const Vector<3> &x, double tolerance) const;

private:
  std::vector<CurvedPiece> pieces_;
  BoxTree<3> tree_;

  struct Nearest {
    Index piece = none;
    std::array<double, 3> weights{};
    double distance = std::numeric_limits<double>::infinity(); ///< squared
  };
  struct Approach {
    Nearest at;
    Vector<3> shift; ///< from there to the foot
  };
  [[nodiscard]] Approach approach(const Vector<3> &x, const FeatureSet &among) const;
  [[nodiscard]] Nearest on_piece(const Vector<3> &x, Index piece) const;
  [[nodiscard]] Nearest nearest(const Vector<3> &x, Index start,
                                const FeatureSet &among) const;
};

/// The smooth surfaces and ridges of a geometry, apart by tag.
class SmoothSurface {
public:
  explicit SmoothSurface(const SurfaceInput &geometry);

  /// The pieces with this tag, null when the geometry has none.
  [[nodiscard]] const CurvedPieces *surface(Index tag) const {
    return find(surfaces_, tag);
  }
  /// @param is_given whether the ridge has a tag of its own.
  [[nodiscard]] const CurvedPieces *ridge(bool is_given, Index tag) const {
    return find(ridges_, is_given ? tag : untagged);
  }
  [[nodiscard]] std::size_t n_patches() const { return n_patches_; }
  [[nodiscard]] std::size_t n_curves() const { return n_curves_; }
  /// @param among the curves that count
  [[nodiscard]] double distance_to_ridges(const Vector<3> &x,
                                          const FeatureSet &among) const;
  /// Those of the ridges without a tag; their segments are the pieces.
  [[nodiscard]] const RidgeChains &chains() const { return chains_; }
  [[nodiscard]] const Jets &jets() const { return jets_; }
  [[nodiscard]] const std::vector<RidgeSegment> &segments() const { return segments_; }

private:
  /// Ridges that an angle made carry no tag of their own.
  static constexpr Index untagged = std::numeric_limits<Index>::min();
  using Tagged = std::vector<std::pair<Index, CurvedPieces>>;
  Tagged surfaces_, ridges_;
  Jets jets_;
  std::vector<RidgeSegment> segments_;
  RidgeChains chains_;
  std::size_t n_patches_ = 0, n_curves_ = 0;

  [[nodiscard]] static const CurvedPieces *find(const Tagged &all, Index tag);
};

} // namespace anistar
