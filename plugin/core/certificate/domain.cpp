#include "certificate/domain.h"

#include <algorithm>
#include <utility>

namespace anistar {

template <std::size_t d> Domain<d>::Domain(CertifiedMesh<d> mesh) : mesh_(mesh) {
  // above that of the foot of a point on the boundary, relative to the coordinates
  constexpr double round_off = 1e-12;
  for (const Vertex<d> &v : mesh.vertices)
    box_.extend(v.x);
  const double largest =
      std::max(box_.low.cwiseAbs().maxCoeff(), box_.high.cwiseAbs().maxCoeff());
  box_.low.array() -= round_off * largest;
  box_.high.array() += round_off * largest;
}

template <std::size_t d> bool Domain<d>::holds(const Vector<d> &x, Index &start) const {
  if ((x.array() < box_.low.array() || x.array() > box_.high.array()).any())
    return false;
  if (const Index found = walk(x, start); found != none) {
    start = found;
    return true;
  }
  return locator().locate(x, none).distance == 0;
}

template <std::size_t d> const Locator<d> &Domain<d>::locator() const {
  return locator_.get([&] {
    std::vector<Vector<d>> points;
    for (const Vertex<d> &v : mesh_.vertices)
      points.push_back(v.x);
    return Locator<d>(points, mesh_.cells);
  });
}

template <std::size_t d>
std::size_t Domain<d>::way_out(Index cell, const Vector<d> &x) const {
  const Cell<d> &corners = mesh_.cells[cell];
  Simplex<d> s;
  for (std::size_t k = 0; k <= d; ++k)
    s[k] = mesh_.vertices[corners[k]].x;
  for (std::size_t i = 0; i <= d; ++i) {
    const Vector<d> corner = std::exchange(s[i], x);
    if (orientation<d>(s) == Orientation::negative)
      return i;
    s[i] = corner;
  }
  return d + 1;
}

template <std::size_t d> Index Domain<d>::walk(const Vector<d> &x, Index start) const {
  constexpr int max_steps = 32;
  Index c = start;
  for (int step = 0; step < max_steps && c != none; ++step) {
    const std::size_t i = way_out(c, x), from = c;
    if (i > d)
      return c;
    c = mesh_.neighbours[from][i].cell();
  }
  return none;
}

template class Domain<2>;
template class Domain<3>;

} // namespace anistar
