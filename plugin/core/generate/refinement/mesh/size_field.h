#pragma once
// The size h(x) that is asked for: a constant, or values at the points of the first
// mesh, linear in its cells.

#include "generate/tetrahedralisation.h"
#include "mesh/adjacency.h"

#include <limits>
#include <span>
#include <vector>

namespace anistar::generate {

class SizeField {
public:
  static constexpr double no_size = std::numeric_limits<double>::infinity();

  SizeField() = default;
  explicit SizeField(double constant) : constant_(constant) {}
  /// @param at_points positive, one for each point of the mesh
  SizeField(const Tetrahedralisation &mesh, std::span<const double> at_points);

  [[nodiscard]] bool is_given() const {
    return constant_ < no_size || !at_points_.empty();
  }
  /// The size at x; the search starts where the vertex was found.
  [[nodiscard]] double at(const Vector<3> &x, Index near) const;
  /// Notes where a new vertex is, from a vertex near it.
  void add_vertex(const Vector<3> &x, Index near);

private:
  double constant_ = no_size;
  std::vector<double> at_points_;
  std::vector<Vector<3>> points_;
  std::vector<Cell<3>> cells_;
  std::vector<Neighbours<3>> neighbours_;
  std::vector<Index> cell_of_vertex_;

  [[nodiscard]] Index locate(const Vector<3> &x, Index start) const;
};

} // namespace anistar::generate
