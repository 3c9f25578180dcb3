#include "generate/constrained/points/exact_points.h"

#include <CGAL/Mpzf.h>

#include <algorithm>
#include <limits>

namespace anistar::generate {
namespace {

using Number = CGAL::Mpzf;
using Differences = std::array<Number, 3>;

constexpr double round_off = anistar::detail::round_off;
/// Relative error of the lifted determinant: the roundings that a term goes through.
constexpr double sphere_bound = 24 * round_off;

Number minor_of(const Differences &u, const Differences &v, int i, int j) {
  return u[i] * v[j] - u[j] * v[i];
}

Number square(const Differences &u) { return u[0] * u[0] + u[1] * u[1] + u[2] * u[2]; }

Number determinant(const Differences &u, const Differences &v, const Differences &w) {
  return w[2] * minor_of(u, v, 0, 1) + w[0] * minor_of(u, v, 1, 2) +
         w[1] * minor_of(u, v, 2, 0);
}

Orientation as_orientation(CGAL::Sign sign) {
  return static_cast<Orientation>(static_cast<int>(sign));
}

/// The largest magnitude of a coordinate of u, which is off by an error.
double reach_of(const Vector<3> &u, double error) {
  return std::max({std::abs(u[0]), std::abs(u[1]), std::abs(u[2])}) + error;
}

/// The orientation of points whose differences are off by so much; degenerate where
/// that leaves doubts.
Orientation filtered_orientation(const Vector<3> &a, const Vector<3> &b,
                                 const Vector<3> &c, const Vector<3> &e, double apart) {
  const Vector<3> u = b - a, v = c - a, w = e - a;
  const double det = w.dot(u.cross(v));
  const double U = reach_of(u, apart), V = reach_of(v, apart), W = reach_of(w, apart);
  // six terms of three factors: what rounding them makes, and what is off beforehand
  const double bound =
      6 * (8 * round_off * U * V * W + apart * (V * W + U * W + U * V));
  if (!(bound > anistar::detail::underflow_guard && std::abs(det) > bound))
    return Orientation::degenerate;
  return det > 0 ? Orientation::positive : Orientation::negative;
}

} // namespace

struct ExactPoints::Exact {
  Differences x;

  friend Differences operator-(const Exact &a, const Exact &b) {
    return {a.x[0] - b.x[0], a.x[1] - b.x[1], a.x[2] - b.x[2]};
  }
};

ExactPoints::ExactPoints(std::span<const Vector<3>> given)
    : n_given_(static_cast<Index>(given.size())), rounded_(given.begin(), given.end()),
      error_(given.size(), 0), planes_(given.size()) {}

ExactPoints::ExactPoints(ExactPoints &&) noexcept = default;
ExactPoints::~ExactPoints() = default;

ExactPoints::Exact ExactPoints::exact(Index v) const {
  if (v >= n_given_)
    return *exact_[v - n_given_];
  return exact(rounded_[v]);
}

ExactPoints::Exact ExactPoints::exact(const Vector<3> &x) {
  return {{Number(x[0]), Number(x[1]), Number(x[2])}};
}

Index ExactPoints::add(const SteinerPoint &point) {
  rounded_.emplace_back();
  error_.push_back(0);
  steiner_.push_back(point);
  exact_.emplace_back();
  place(size() - 1);
  std::vector<Index> shared;
  std::ranges::set_intersection(planes_[point.a], planes_[point.b],
                                std::back_inserter(shared));
  planes_.push_back(std::move(shared));
  return size() - 1;
}

void ExactPoints::remove_last() {
  rounded_.pop_back();
  error_.pop_back();
  planes_.pop_back();
  steiner_.pop_back();
  exact_.pop_back();
}

void ExactPoints::move(Index v, double t) {
  steiner_[v - n_given_].t = t;
  place(v);
}

void ExactPoints::place(Index v) {
  const auto [a, b, t] = steiner(v);
  const Exact from = exact(a);
  const Differences step = exact(b) - from;
  auto made = std::make_unique<Exact>();
  Vector<3> &x = rounded_[v];
  error_[v] = 0;
  for (int i = 0; i < 3; ++i) {
    made->x[i] = from.x[i] + Number(t) * step[i];
    x[i] = CGAL::to_double(made->x[i]);
    if (made->x[i] != Number(x[i]))
      error_[v] = std::max(error_[v], 4 * round_off * std::abs(x[i]));
  }
  exact_[v - n_given_] = std::move(made);
}

void ExactPoints::put_on_plane(Index v, Index plane) {
  std::vector<Index> &planes = planes_[v];
  const auto at = std::ranges::lower_bound(planes, plane);
  if (at == planes.end() || *at != plane)
    planes.insert(at, plane);
}

bool ExactPoints::share_plane(Index a, Index b, Index c, Index e) const {
  const auto is_on = [this](Index v, Index plane) {
    return std::ranges::binary_search(planes_[v], plane);
  };
  return std::ranges::any_of(planes_[a], [&](Index plane) {
    return is_on(b, plane) && is_on(c, plane) && is_on(e, plane);
  });
}

Orientation ExactPoints::orientation(Index a, Index b, Index c, Index e) const {
  ++counts_.asked;
  const double apart = 2 * std::max({error_[a], error_[b], error_[c], error_[e]});
  if (apart == 0)
    return anistar::orientation(rounded_[a], rounded_[b], rounded_[c], rounded_[e]);
  const Orientation filtered =
      filtered_orientation(rounded_[a], rounded_[b], rounded_[c], rounded_[e], apart);
  if (filtered != Orientation::degenerate || share_plane(a, b, c, e))
    return filtered;
  return exact_orientation(exact(a), exact(b), exact(c), exact(e));
}

Orientation ExactPoints::orientation(Index a, Index b, Index c,
                                     const Vector<3> &x) const {
  const double apart = 2 * std::max({error_[a], error_[b], error_[c]});
  const Orientation filtered =
      filtered_orientation(rounded_[a], rounded_[b], rounded_[c], x, apart);
  return filtered != Orientation::degenerate
             ? filtered
             : exact_orientation(exact(a), exact(b), exact(c), exact(x));
}

Orientation ExactPoints::exact_orientation(const Exact &a, const Exact &b,
                                           const Exact &c, const Exact &e) const {
  ++counts_.exact;
  return as_orientation(CGAL::sign(determinant(b - a, c - a, e - a)));
}

Side ExactPoints::side_of_sphere(const Cell<3> &cell, Index p) const {
  const auto [a, b, c, e] = cell;
  const double apart =
      2 * std::max({error_[a], error_[b], error_[c], error_[e], error_[p]});
  const Vector<3> &origin = rounded_[p];
  const Vector<3> u = rounded_[a] - origin, v = rounded_[b] - origin,
                  w = rounded_[c] - origin, s = rounded_[e] - origin;
  const Vector<3> u_v = u.cross(v), w_s = w.cross(s);
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), ww = w.squaredNorm(),
               ss = s.squaredNorm();
  const double det = u_v.dot(ww * s - ss * w) + w_s.dot(uu * v - vv * u);
  const double U = reach_of(u, apart), V = reach_of(v, apart), W = reach_of(w, apart),
               S = reach_of(s, apart);
  // 72 terms U V W S times one of them, and their derivatives where something is off
  const double product = U * V * W * S, sum = U + V + W + S;
  const double slope = V * W * S + U * W * S + U * V * S + U * V * W;
  const double bound =
      18 * (sphere_bound * product * sum + apart * (slope * sum + 4 * product));
  if (bound > anistar::detail::underflow_guard && std::abs(det) > bound)
    return det > 0 ? Side::inside : Side::outside;
  return exact_side_of_sphere(cell, p);
}

Side ExactPoints::exact_side_of_sphere(const Cell<3> &cell, Index p) const {
  ++counts_.exact;
  const Exact origin = exact(p);
  const Differences u = exact(cell[0]) - origin, v = exact(cell[1]) - origin,
                    w = exact(cell[2]) - origin, s = exact(cell[3]) - origin;
  const Number value =
      square(s) * determinant(u, v, w) - square(w) * determinant(u, v, s) +
      square(v) * determinant(u, w, s) - square(u) * determinant(v, w, s);
  return static_cast<Side>(-static_cast<int>(CGAL::sign(value)));
}

bool ExactPoints::is_in_sphere(const Cell<3> &cell, Index p) const {
  ++counts_.asked;
  switch (side_of_sphere(cell, p)) {
  case Side::inside:
    return true;
  case Side::outside:
    return false;
  default:
    return perturbed_is_in_sphere(cell, p);
  }
}

bool ExactPoints::perturbed_is_in_sphere(const Cell<3> &cell, Index p) const {
  // slots 0 to 3 are the vertices of the cell, 4 is p
  const std::array<Index, 5> point{cell[0], cell[1], cell[2], cell[3], p};
  std::array<int, 5> order{0, 1, 2, 3, 4};
  std::ranges::sort(order,
                    [&](int i, int j) { return compare(point[i], point[j]) < 0; });
  for (std::size_t i = 4; i > 0; --i) {
    if (order[i] == 4)
      return false;
    Cell<3> moved = cell;
    moved[order[i]] = p;
    const Orientation turn = orientation(moved[0], moved[1], moved[2], moved[3]);
    if (turn != Orientation::degenerate)
      return turn == Orientation::positive;
  }
  return false;
}

int ExactPoints::compare(Index a, Index b) const {
  const double apart = error_[a] + error_[b];
  for (int i = 0; i < 3; ++i) {
    const double gap = rounded_[a][i] - rounded_[b][i];
    if (std::abs(gap) > apart)
      return gap < 0 ? -1 : 1;
    if (apart == 0)
      continue;
    const CGAL::Sign sign = CGAL::sign(exact(a).x[i] - exact(b).x[i]);
    if (sign != CGAL::ZERO)
      return static_cast<int>(sign);
  }
  return 0;
}

bool ExactPoints::are_collinear(Index a, Index b, Index p) const {
  const double apart = 2 * std::max({error_[a], error_[b], error_[p]});
  const Vector<3> from_a = rounded_[b] - rounded_[a], to_p = rounded_[p] - rounded_[a];
  const double U = reach_of(from_a, apart), V = reach_of(to_p, apart);
  const double bound = 2 * (4 * round_off * U * V + apart * (U + V));
  if (bound > anistar::detail::underflow_guard &&
      from_a.cross(to_p).cwiseAbs().maxCoeff() > bound)
    return false;
  const Exact origin = exact(a);
  const Differences u = exact(b) - origin, v = exact(p) - origin;
  return CGAL::is_zero(minor_of(u, v, 0, 1)) && CGAL::is_zero(minor_of(u, v, 1, 2)) &&
         CGAL::is_zero(minor_of(u, v, 2, 0));
}

} // namespace anistar::generate
