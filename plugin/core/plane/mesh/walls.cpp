#include "plane/mesh/walls.h"

#include "base/predicates.h"

#include <algorithm>

namespace anistar {
namespace {

bool all_beyond(const Vector<2> &a, const Vector<2> &b,
                std::span<const Vector<2> *const> points, Orientation side) {
  return std::all_of(points.begin(), points.end(),
                     [&](const Vector<2> *p) { return orientation(a, b, *p) == side; });
}

/// Whether the closed segment pq meets the closed, positive triangle: no side of either
/// parts them.
bool meets(const Simplex<2> &s, const Vector<2> &p, const Vector<2> &q) {
  const Vector<2> *const segment[2] = {&p, &q};
  for (std::size_t i = 0; i < 3; ++i)
    if (all_beyond(s[i], s[(i + 1) % 3], segment, Orientation::negative))
      return false;
  const Vector<2> *const triangle[3] = {&s[0], &s[1], &s[2]};
  return !all_beyond(p, q, triangle, Orientation::positive) &&
         !all_beyond(p, q, triangle, Orientation::negative);
}

/// Whether a segment from corner i of the triangle to q enters it or runs along it.
bool enters(const Simplex<2> &s, std::size_t i, const Vector<2> &q) {
  return orientation(s[i], s[(i + 1) % 3], q) != Orientation::negative &&
         orientation(s[i], s[(i + 2) % 3], q) != Orientation::positive;
}

} // namespace

Walls::Walls(const Triangulation<2> &mesh, const std::vector<CurveEdge> &edges,
             const Geometry &geometry)
    : mesh_(mesh), edges_(edges), tree_(collect(geometry)) {}

std::vector<Box<2>> Walls::collect(const Geometry &geometry) {
  std::vector<Box<2>> boxes;
  place_.assign(edges_.size(), none);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (!geometry.curves[edges_[e].curve].is_boundary())
      continue;
    place_[e] = static_cast<Index>(boxes.size());
    entries_.push_back({static_cast<Index>(e)});
    Box<2> box;
    box.extend(x(edges_[e].v0));
    box.extend(x(edges_[e].v1));
    boxes.push_back(box);
  }
  return boxes;
}

bool Walls::is_clear(const Curve &curve, const Vector<2> &a, Index a_index,
                     const Vector<2> &b, Index b_index, const Vector<2> &x,
                     std::span<const Index> replaced) const {
  if (!curve.is_boundary())
    return true;
  const bool is_left = curve.left != no_region;
  if (orientation(a, b, x) != (is_left ? Orientation::negative : Orientation::positive))
    return true;
  const Simplex<2> swept = is_left ? Simplex<2>{b, a, x} : Simplex<2>{a, b, x};
  const Index corner[2] = {is_left ? b_index : a_index, is_left ? a_index : b_index};
  Box<2> box;
  for (const Vector<2> &p : swept)
    box.extend(p);
  bool clear = true;
  const auto blocks = [&](Index entry) {
    if (std::find(replaced.begin(), replaced.end(), entry) != replaced.end())
      return false;
    const Index v0 = edges_[entry].v0;
    const Index v1 = edges_[entry].v1;
    const bool has0 = v0 == corner[0] || v1 == corner[0];
    const bool has1 = v0 == corner[1] || v1 == corner[1];
    if (has0 && has1)
      return true;
    if (has0 || has1) {
      const std::size_t i = has0 ? 0 : 1;
      return enters(swept, i, this->x(v0 == corner[i] ? v1 : v0));
    }
    return meets(swept, this->x(v0), this->x(v1));
  };
  tree_.meeting(box, [&](Index k) {
    const auto &here = entries_[k];
    clear = std::none_of(here.begin(), here.end(), blocks);
    return clear;
  });
  return clear;
}

void Walls::add(Index now, Index before) {
  const Index k = place(before);
  if (k == none)
    return;
  place_.resize(std::max(place_.size(), static_cast<std::size_t>(now) + 1), none);
  place_[now] = k;
  entries_[k].push_back(now);
  const CurveEdge &edge = edges_[now];
  extend(now, x(edge.v0));
  extend(now, x(edge.v1));
}

void Walls::remove(Index gone) {
  if (place(gone) != none)
    std::erase(entries_[place(gone)], gone);
}

void Walls::extend(Index entry, const Vector<2> &x) {
  if (place(entry) != none)
    tree_.extend(place(entry), x);
}

} // namespace anistar
