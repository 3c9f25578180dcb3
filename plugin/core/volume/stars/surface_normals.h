#pragma once
// The normals of curved surfaces at the vertices of a volume mesh.

#include "volume/mesh/volume.h"

namespace anistar {

/// Found once, and again where a vertex moves: it costs a projection. A vertex of a
/// ridge has one for every curved patch there.
class SurfaceNormals {
public:
  struct Normal {
    Index patch;
    Vector<3> along; ///< of unit length, in either direction
  };

  SurfaceNormals(const Volume &volume, int threads);

  /// Those at a vertex; none of them on planes.
  [[nodiscard]] std::span<const Normal> at(Index v) const {
    return std::span(normals_).subspan(begin(v), begin(v + 1) - begin(v));
  }
  /// Null where the patch is a plane.
  [[nodiscard]] const Vector<3> *at(Index v, Index patch) const;
  /// Of a vertex that moves. @param normals as at(v) has them
  void put(Index v, std::span<const Normal> normals) {
    std::copy(normals.begin(), normals.end(), normals_.begin() + begin(v));
  }

private:
  std::vector<Normal> normals_;
  std::vector<std::ptrdiff_t> begin_; ///< of the normals of a vertex; one more

  /// Vertices that came later are on no curved surface.
  [[nodiscard]] std::ptrdiff_t begin(Index v) const {
    return std::cmp_less(v, begin_.size()) ? begin_[v] : begin_.back();
  }
};

} // namespace anistar
