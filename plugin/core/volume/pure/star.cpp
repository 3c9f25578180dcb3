#include "volume/pure/star.h"

#include "base/errors.h"
#include "volume/pure/power_test.h"

#include <algorithm>

namespace anistar {
namespace {

constexpr std::uint16_t nowhere = 0xffff;
/// The first mirror site; the others follow downwards. `none` is no site.
constexpr Index first_mirror = -2;
/// Boxes are made of rounded balls.
constexpr double rounding_room = 1 + 1e-9;

/// The centre of a cell whose ball is known no better than to this part is that of a
/// nearly flat one.
constexpr double blurred = 1e-9;

WeightedPoint weighted(const Star::Seen &s) { return {s.x, s.weight, s.site}; }

/// The lift of a site by the weights, with the error of one more rounding. The cells of
/// a star are in the order of their corners only while all lifts are positive.
void lift(StarPoint<3> &at, double by) {
  const double before = at.square;
  at.square += by;
  at.sq_error += 2 * detail::round_off * (std::abs(before) + std::abs(by));
  if (!(at.square > at.sq_error))
    at.sq_error = std::numeric_limits<double>::infinity();
}

} // namespace

Star::Star(Index v, const Site &site, const Box<3> &box)
    : M_(site.vertex.M),
      frame_(site.vertex), vertex_{v, site.vertex.x, site.weight, {}} {
  const Matrix<3> inverse = lower_factor<3>(M_).inverse();
  to_space_ = inverse.transpose();
  extents_ = to_space_.rowwise().norm();
  close(box);
}

/// The mirror sites, low and high along every axis, and the eight triangles of them.
void Star::close(const Box<3> &box) {
  const Matrix<3> inverse = to_space_ * to_space_.transpose();
  for (int k = 0; k < 6; ++k) {
    const int axis = k / 2;
    const double to_side = (k % 2 == 0 ? box.low : box.high)[axis] - vertex_.x[axis];
    const Vector<3> x =
        vertex_.x + 2 * to_side / inverse(axis, axis) * inverse.col(axis);
    corners_.push_back(see(first_mirror - k, x, 0));
  }
  link_.resize(8);
  for (unsigned octant = 0; octant < 8; ++octant) {
    LinkTriangle &t = link_[octant];
    std::array<std::uint16_t, 3> side, corner;
    for (unsigned axis = 0; axis < 3; ++axis) {
      corner[axis] = static_cast<std::uint16_t>(2 * axis + (octant >> axis & 1));
      side[axis] = static_cast<std::uint16_t>(octant ^ 1u << axis);
    }
    const bool is_positive = ((octant ^ octant >> 1 ^ octant >> 2) & 1) != 0;
    t.corners = corner;
    t.across = side;
    if (!is_positive) {
      std::swap(t.corners[1], t.corners[2]);
      std::swap(t.across[1], t.across[2]);
    }
    measure(t);
  }
  gather();
}

Star::Seen Star::see(Index site, const Vector<3> &x, double weight) const {
  Seen seen{site, x, weight, frame_.point(x)};
  if (weight != vertex_.weight)
    lift(seen.at, vertex_.weight - weight);
  return seen;
}

void Star::measure(LinkTriangle &t) const {
  t.ball = star_ball<3>({&corners_[t.corners[0]].at, &corners_[t.corners[1]].at,
                         &corners_[t.corners[2]].at});
  if (t.ball.error <= blurred * t.ball.length) {
    const Vector<3> half = .5 * t.ball.gradient;
    t.centre = vertex_.x + to_space_ * half;
    t.square_radius = half.squaredNorm() - vertex_.weight;
  } else {
    t.centre = exact_centre(M_, {weighted(vertex_), weighted(corners_[t.corners[0]]),
                                 weighted(corners_[t.corners[1]]),
                                 weighted(corners_[t.corners[2]])});
    t.square_radius = square_radius(t.centre);
  }
}

bool Star::lies_inside(const LinkTriangle &t, const Seen &p) const {
  const Bounded power = t.ball.power(p.at);
  if (power.is_negative())
    return true;
  if (power.is_positive())
    return false;
  return exact_power_side(M_, {weighted(vertex_), weighted(corners_[t.corners[0]]),
                               weighted(corners_[t.corners[1]]),
                               weighted(corners_[t.corners[2]]), weighted(p)}) ==
         anistar::Side::inside;
}

bool Star::conflicts(const Seen &p) const {
  return std::any_of(link_.begin(), link_.end(),
                     [&](const LinkTriangle &t) { return lies_inside(t, p); });
}

std::vector<std::uint8_t> Star::conflict(const Seen &p) const {
  std::vector<std::uint8_t> inside(link_.size());
  for (std::size_t k = 0; k < link_.size(); ++k)
    inside[k] = lies_inside(link_[k], p);
  return inside;
}

/// The sides around the triangles that are inside.
std::vector<Star::Side> Star::rim(const std::vector<std::uint8_t> &inside) const {
  std::vector<Side> sides;
  for (std::size_t k = 0; k < link_.size(); ++k)
    for (std::size_t i = 0; inside[k] != 0 && i < 3; ++i)
      if (inside[link_[k].across[i]] == 0)
        sides.push_back({link_[k].corners[(i + 1) % 3], link_[k].corners[(i + 2) % 3],
                         static_cast<std::uint16_t>(k), link_[k].across[i]});
  return sides;
}

void Star::horizon(const Seen &p, std::vector<std::array<Index, 2>> &sides) const {
  sides.clear();
  for (const Side &side : rim(conflict(p)))
    sides.push_back({corners_[side.a].site, corners_[side.b].site});
}

bool Star::insert(const Seen &p) {
  std::vector<std::uint8_t> inside = conflict(p);
  const std::vector<Side> sides = rim(inside);
  if (sides.empty() || !is_cycle(sides))
    return false;
  insist_on_numbers(sides.size());
  corners_.push_back(p);
  join(sides, static_cast<std::uint16_t>(corners_.size() - 1));
  drop(inside);
  drop_corners();
  gather();
  return true;
}

/// Whether every corner on the rim begins one side of it and ends one: it does unless
/// the ball of p hides the vertex.
bool Star::is_cycle(const std::vector<Side> &sides) const {
  std::vector<std::uint8_t> seen(corners_.size(), 0);
  for (const Side &side : sides) {
    if ((seen[side.a] & 1) != 0 || (seen[side.b] & 2) != 0)
      return false;
    seen[side.a] |= 1;
    seen[side.b] |= 2;
  }
  return std::none_of(seen.begin(), seen.end(),
                      [](std::uint8_t bits) { return bits == 1 || bits == 2; });
}

/// For so many more triangles, and a corner: a closed surface has fewer of these.
void Star::insist_on_numbers(std::size_t n_more) const {
  if (const std::size_t n = link_.size() + n_more; n >= nowhere)
    throw MeshingError("a vertex would have " + std::to_string(n) +
                           " cells in its star; at most " +
                           std::to_string(nowhere - 1) + " can be numbered",
                       vertex_.x);
}

/// Joins p to the sides of the rim.
void Star::join(const std::vector<Side> &sides, std::uint16_t p) {
  std::vector<std::uint16_t> starting(corners_.size(), nowhere),
      ending(corners_.size(), nowhere);
  const std::size_t n = link_.size();
  for (const Side &side : sides) {
    const auto here = static_cast<std::uint16_t>(link_.size());
    auto &back = link_[side.beyond].across;
    *std::find(back.begin(), back.end(), side.from) = here;
    starting[side.a] = ending[side.b] = here;
    LinkTriangle t;
    t.corners = {side.a, side.b, p};
    t.across[2] = side.beyond;
    measure(t);
    link_.push_back(t);
  }
  for (std::size_t k = n; k < link_.size(); ++k) {
    LinkTriangle &t = link_[k];
    t.across[0] = starting[t.corners[1]];
    t.across[1] = ending[t.corners[0]];
  }
}

/// The triangles that are inside.
void Star::drop(std::vector<std::uint8_t> &inside) {
  inside.resize(link_.size(), 0);
  std::vector<std::uint16_t> moved(link_.size(), nowhere);
  std::uint16_t n = 0;
  for (std::size_t k = 0; k < link_.size(); ++k)
    if (inside[k] == 0) {
      moved[k] = n;
      if (n != k)
        link_[n] = link_[k];
      ++n;
    }
  link_.resize(n);
  for (LinkTriangle &t : link_)
    for (std::uint16_t &side : t.across)
      side = moved[side];
}

/// Those that no triangle has any more.
void Star::drop_corners() {
  std::vector<std::uint16_t> moved(corners_.size(), nowhere);
  for (const LinkTriangle &t : link_)
    for (std::uint16_t corner : t.corners)
      moved[corner] = 0;
  std::uint16_t n = 0;
  for (std::size_t k = 0; k < corners_.size(); ++k)
    if (moved[k] == 0) {
      moved[k] = n;
      if (n != k)
        corners_[n] = corners_[k];
      ++n;
    }
  corners_.resize(n);
  for (LinkTriangle &t : link_)
    for (std::uint16_t &corner : t.corners)
      corner = moved[corner];
}

/// What is kept of all triangles side by side.
void Star::gather() {
  balls_ = {};
  sorted_.resize(link_.size());
  for (std::size_t k = 0; k < link_.size(); ++k) {
    const LinkTriangle &t = link_[k];
    const double r = rounding_room * std::sqrt(std::max(0., t.square_radius));
    balls_.extend(t.centre - r * extents_);
    balls_.extend(t.centre + r * extents_);
    sorted_[k] = {site(t, 0), site(t, 1), site(t, 2)};
    std::sort(sorted_[k].begin(), sorted_[k].end());
  }
}

std::optional<std::size_t> Star::find(const StarSimplex &sites) const {
  const auto found = std::find(sorted_.begin(), sorted_.end(), sites);
  if (found == sorted_.end())
    return std::nullopt;
  return static_cast<std::size_t>(found - sorted_.begin());
}

} // namespace anistar
