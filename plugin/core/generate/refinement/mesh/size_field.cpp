#include "generate/refinement/mesh/size_field.h"

#include "base/predicates.h"

#include <algorithm>

namespace anistar::generate {
namespace {

/// Volumes of x with the four facets of a cell.
std::array<double, 4> shares(const Simplex<3> &s, const Vector<3> &x) {
  std::array<double, 4> out;
  for (std::size_t i = 0; i < 4; ++i) {
    Simplex<3> part = s;
    part[i] = x;
    out[i] = volume_determinant<3>(part);
  }
  return out;
}

} // namespace

SizeField::SizeField(const Tetrahedralisation &mesh, std::span<const double> at_points)
    : at_points_(at_points.begin(), at_points.end()), points_(mesh.points),
      cells_(mesh.cells), neighbours_(adjacency<3>(mesh.cells, mesh.points.size())),
      cell_of_vertex_(mesh.points.size(), 0) {
  for (std::size_t c = 0; c < cells_.size(); ++c)
    for (Index v : cells_[c])
      cell_of_vertex_[v] = static_cast<Index>(c);
}

Index SizeField::locate(const Vector<3> &x, Index start) const {
  Index c = start, before = none;
  for (std::size_t step = 0; step < cells_.size(); ++step) {
    const Cell<3> &v = cells_[c];
    const auto share =
        shares({points_[v[0]], points_[v[1]], points_[v[2]], points_[v[3]]}, x);
    Index next = none;
    double least = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const HalfFacet n = neighbours_[c][i];
      if (share[i] < least && n.exists() && n.cell() != before) {
        least = share[i];
        next = n.cell();
      }
    }
    if (next == none)
      break; // here, or outside beyond this cell
    before = c;
    c = next;
  }
  return c;
}

double SizeField::at(const Vector<3> &x, Index near) const {
  if (at_points_.empty())
    return constant_;
  const Cell<3> &v = cells_[locate(x, cell_of_vertex_[near])];
  const auto share =
      shares({points_[v[0]], points_[v[1]], points_[v[2]], points_[v[3]]}, x);
  double sum = 0, size = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double weight = std::max(share[i], 0.);
    sum += weight;
    size += weight * at_points_[v[i]];
  }
  return sum > 0 ? size / sum : at_points_[v[0]];
}

void SizeField::add_vertex(const Vector<3> &x, Index near) {
  if (!at_points_.empty())
    cell_of_vertex_.push_back(locate(x, cell_of_vertex_[near]));
}

} // namespace anistar::generate
