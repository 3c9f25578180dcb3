#include "volume/mesh/cones.h"

namespace anistar {
namespace {

/// Sines of angles below this are contacts: far above the round-off of the places where
/// an edge is split, far below any gap that a mesh resolves.
constexpr double contact = 1e-9;

/// The directions of the corners of both cones, those of the first one first.
class ConePair {
public:
  ConePair(const Vector<3> &vertex, const Cone &one, const Cone &other) {
    for (std::size_t k = 0; k < 3; ++k) {
      direction_[k] = (one.corners[k] - vertex).normalized();
      direction_[3 + k] = (other.corners[k] - vertex).normalized();
      is_common_[k] = other.contains(one.vertices[k]);
      is_common_[3 + k] = one.contains(other.vertices[k]);
    }
  }

  /// Whether a plane through the vertex and two corners is between the cones.
  [[nodiscard]] bool has_plane_between() const {
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = i + 1; j < 6; ++j) {
        const Vector<3> normal = direction_[i].cross(direction_[j]);
        const double sine = normal.norm();
        if (sine > contact && is_between(normal / sine))
          return true;
      }
    return false;
  }

private:
  using Sides = std::array<int, 6>; ///< of the corners; 0: on the plane or line
  static constexpr int does_not_count = 2;

  std::array<Vector<3>, 6> direction_;
  std::array<bool, 6> is_common_;

  [[nodiscard]] static int side(double sine) {
    return sine > contact ? 1 : sine < -contact ? -1 : 0;
  }

  /// Whether no cone is on both sides, and both are not on one.
  [[nodiscard]] static bool are_parted(const Sides &sides) {
    int first = 0; ///< the side of the first cone
    for (std::size_t k = 0; k < 6; ++k) {
      if (sides[k] == 0 || sides[k] == does_not_count)
        continue;
      const int of_first = k < 3 ? sides[k] : -sides[k];
      if (first != 0 && of_first != first)
        return false;
      first = of_first;
    }
    return true;
  }

  /// Whether one of the cones has nothing of its own on the plane or line.
  [[nodiscard]] bool only_common(const Sides &sides) const {
    bool one = true, other = true;
    for (std::size_t k = 0; k < 6; ++k)
      if (sides[k] == 0 && !is_common_[k])
        (k < 3 ? one : other) = false;
    return one || other;
  }

  [[nodiscard]] bool is_between(const Vector<3> &normal) const {
    Sides sides{};
    for (std::size_t k = 0; k < 6; ++k)
      sides[k] = side(normal.dot(direction_[k]));
    return are_parted(sides) &&
           (only_common(sides) || are_apart_on_plane(normal, sides));
  }

  /// The same for what the cones have on a plane, with a line through the vertex and a
  /// corner. @param on_plane 0 for the corners there
  [[nodiscard]] bool are_apart_on_plane(const Vector<3> &normal,
                                        const Sides &on_plane) const {
    for (std::size_t i = 0; i < 6; ++i) {
      if (on_plane[i] != 0)
        continue;
      const Vector<3> across = normal.cross(direction_[i]);
      Sides sides{}, along{}; // of the line, and of its half that has the corner
      for (std::size_t k = 0; k < 6; ++k) {
        sides[k] = on_plane[k] == 0 ? side(across.dot(direction_[k])) : does_not_count;
        along[k] = direction_[i].dot(direction_[k]) > 0 ? sides[k] : does_not_count;
      }
      if (are_parted(sides) && only_common(along))
        return true;
    }
    return false;
  }
};

} // namespace

Cone cone_at(const Triangulation<3> &mesh, const Cell<3> &cell, Index vertex) {
  Cone cone{};
  std::size_t n = 0;
  for (Index v : cell)
    if (v != vertex && n < 3) {
      cone.vertices[n] = v;
      cone.corners[n++] = mesh.vertex(v).x;
    }
  return cone;
}

bool are_apart(const Vector<3> &vertex, const Cone &one, const Cone &other) {
  return ConePair(vertex, one, other).has_plane_between();
}

bool is_apart_from_fans(const Volume &volume, Index vertex, const Cone &cone,
                        std::span<const Index> old) {
  const std::vector<Index> &fans = *volume.fans_of(vertex);
  return std::all_of(fans.begin(), fans.end(), [&](Index c) {
    return std::find(old.begin(), old.end(), c) != old.end() ||
           are_apart(volume.mesh.vertex(vertex).x, cone,
                     cone_at(volume.mesh, volume.mesh.at(c), vertex));
  });
}

} // namespace anistar
