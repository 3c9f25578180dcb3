#include "generate/checking/contact.h"

#include "generate/checking/view.h"

#include <algorithm>

namespace anistar::generate {
namespace {

using Edge = std::array<Index, 2>;
constexpr Edge no_edge{none, none};

constexpr bool are_opposite(Orientation a, Orientation b) {
  return static_cast<int>(a) * static_cast<int>(b) < 0;
}

/// Collects what two pieces have in common.
class Encounter {
public:
  Encounter(std::span<const Vector<3>> points, const Piece &a, const Piece &b)
      : points_(points), a_(a), b_(b) {}

  Meeting meeting() {
    const std::size_t shared = n_shared(a_, b_);
    if (shared == a_.n_corners && shared == b_.n_corners)
      return repeated();
    if (is_beside(a_, b_) || is_beside(b_, a_))
      return {};
    land(a_, b_);
    land(b_, a_);
    cross(a_, b_);
    if (!a_.is_segment() || !b_.is_segment())
      cross(b_, a_);
    return verdict();
  }

private:
  std::span<const Vector<3>> points_;
  const Piece &a_, &b_;
  std::vector<Landing> landings_;
  std::vector<Vector<3>> ends_; ///< of what they have in common
  bool is_crossed_ = false;

  [[nodiscard]] const Vector<3> &at(Index v) const { return points_[v]; }
  [[nodiscard]] const Vector<3> &corner(const Piece &p, std::size_t k) const {
    return points_[p.corners[k]];
  }

  [[nodiscard]] Orientation side(const Piece &triangle, Index v) const {
    return triangle.has(v) ? Orientation::degenerate
                           : orientation(corner(triangle, 0), corner(triangle, 1),
                                         corner(triangle, 2), at(v));
  }
  [[nodiscard]] View view(const Piece &triangle) const {
    // not degenerate, by the precondition
    return view_of(corner(triangle, 0), corner(triangle, 1), corner(triangle, 2))
        .value_or(View{0, Orientation::degenerate});
  }

  /// Whether all that `p` does not share with a triangle is strictly on one side of it.
  [[nodiscard]] bool is_beside(const Piece &p, const Piece &triangle) const {
    return triangle.is_triangle() && sides(p, triangle).is_strict;
  }
  struct Sides {
    bool is_strict; ///< what is not shared is strictly on one side
    bool is_weak;   ///< all is on one side, or on the plane
    bool is_flat;   ///< all is on the plane
  };
  [[nodiscard]] Sides sides(const Piece &p, const Piece &triangle) const {
    bool any_above = false, any_below = false, any_on = false;
    for (const Index v : p.points()) {
      if (triangle.has(v))
        continue;
      const Orientation s = side(triangle, v);
      any_above |= s == Orientation::positive;
      any_below |= s == Orientation::negative;
      any_on |= s == Orientation::degenerate;
    }
    return {any_above != any_below && !any_on, !(any_above && any_below),
            !any_above && !any_below};
  }

  /// Finds the points of p that lie on q.
  void land(const Piece &p, const Piece &q) {
    for (const Index v : p.points()) {
      if (q.has(v))
        continue;
      if (q.is_triangle() && side(q, v) == Orientation::degenerate)
        land_in_plane(v, q);
      if (q.is_segment() && is_on(v, q.edge(0)))
        note({v, q.edge(0)});
    }
  }
  void land_in_plane(Index v, const Piece &triangle) {
    const View flat = view(triangle);
    Edge on = no_edge;
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge e = triangle.edge(k);
      const Orientation s = flat.side(at(e[0]), at(e[1]), at(v));
      if (are_opposite(s, flat.turn))
        return;
      if (s == Orientation::degenerate)
        on = e;
    }
    note({v, on});
  }
  void note(const Landing &landing) {
    landings_.push_back(landing);
    ends_.push_back(at(landing.point));
  }

  /// Whether a point is between the ends of an edge.
  [[nodiscard]] bool is_on(Index v, const Edge &e) const {
    return !view_of(at(e[0]), at(e[1]), at(v)) && is_between(v, e);
  }
  /// @pre v is on the line of e.
  [[nodiscard]] bool is_between(Index v, const Edge &e) const {
    for (int i = 0; i < 3; ++i) {
      const double low = std::min(at(e[0])[i], at(e[1])[i]);
      const double high = std::max(at(e[0])[i], at(e[1])[i]);
      if (at(v)[i] < low || at(v)[i] > high)
        return false;
    }
    return true;
  }

  /// Finds the edges of p that go through q or cross an edge of it.
  void cross(const Piece &p, const Piece &q) {
    for (std::size_t k = 0; k < p.n_edges(); ++k) {
      const Edge e = p.edge(k);
      if (q.is_triangle())
        cross_triangle(e, q);
      else if (q.is_segment() && p.is_segment())
        cross_edge(e, q.edge(0));
    }
  }
  void cross_triangle(const Edge &e, const Piece &triangle) {
    const Orientation start = side(triangle, e[0]), end = side(triangle, e[1]);
    if (start == Orientation::degenerate && end == Orientation::degenerate) {
      for (std::size_t k = 0; k < 3; ++k)
        cross_in_plane(e, triangle.edge(k), view(triangle));
      return;
    }
    if (!are_opposite(start, end))
      return;
    bool any_left = false, any_right = false;
    int n_on = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge f = triangle.edge(k);
      const Orientation s = orientation(at(e[0]), at(e[1]), at(f[0]), at(f[1]));
      any_left |= s == Orientation::positive;
      any_right |= s == Orientation::negative;
      n_on += s == Orientation::degenerate ? 1 : 0;
    }
    // on two edges: through a corner, which has landed on e
    if ((any_left && any_right) || n_on > 1)
      return;
    is_crossed_ = true;
    ends_.push_back(passage(e, triangle));
  }
  void cross_edge(const Edge &e, const Edge &f) {
    if (orientation(at(e[0]), at(e[1]), at(f[0]), at(f[1])) != Orientation::degenerate)
      return;
    auto flat = view_of(at(e[0]), at(e[1]), at(f[0]));
    if (!flat)
      flat = view_of(at(e[0]), at(e[1]), at(f[1]));
    if (flat)
      cross_in_plane(e, f, *flat);
  }
  void cross_in_plane(const Edge &e, const Edge &f, const View &flat) {
    const Orientation f0 = flat.side(at(e[0]), at(e[1]), at(f[0])),
                      f1 = flat.side(at(e[0]), at(e[1]), at(f[1])),
                      e0 = flat.side(at(f[0]), at(f[1]), at(e[0])),
                      e1 = flat.side(at(f[0]), at(f[1]), at(e[1]));
    if (!are_opposite(f0, f1) || !are_opposite(e0, e1))
      return;
    is_crossed_ = true;
    const double a = std::abs(cross_product(flat, f, e[0])),
                 b = std::abs(cross_product(flat, f, e[1]));
    ends_.push_back(between(e, a, b));
  }
  [[nodiscard]] double cross_product(const View &flat, const Edge &f, Index v) const {
    const Vector<2> origin = flat.seen(at(f[0]));
    return anistar::cross(flat.seen(at(f[1])) - origin, flat.seen(at(v)) - origin);
  }

  /// Where e passes a triangle, rounded.
  [[nodiscard]] Vector<3> passage(const Edge &e, const Piece &triangle) const {
    const Vector<3> &o = corner(triangle, 0);
    const Vector<3> normal = (corner(triangle, 1) - o).cross(corner(triangle, 2) - o);
    return between(e, std::abs(normal.dot(at(e[0]) - o)),
                   std::abs(normal.dot(at(e[1]) - o)));
  }
  [[nodiscard]] Vector<3> between(const Edge &e, double to_start, double to_end) const {
    const double sum = to_start + to_end;
    const double t = sum > 0 ? to_start / sum : .5;
    return at(e[0]) + t * (at(e[1]) - at(e[0]));
  }

  [[nodiscard]] bool do_overlap() const {
    return a_.is_triangle() && b_.is_triangle() && sides(a_, b_).is_flat &&
           !is_separated(a_, b_) && !is_separated(b_, a_);
  }
  /// Whether an edge of p has q on its other side, in their common plane.
  [[nodiscard]] bool is_separated(const Piece &p, const Piece &q) const {
    const View flat = view(p);
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge e = p.edge(k);
      bool all_outside = true;
      for (const Index v : q.points()) {
        const Orientation s = flat.side(at(e[0]), at(e[1]), at(v));
        all_outside &= s == Orientation::degenerate || are_opposite(s, flat.turn);
      }
      if (all_outside)
        return true;
    }
    return false;
  }

  [[nodiscard]] Meeting verdict() {
    Meeting out;
    if (do_overlap())
      out.contact = Contact::overlap;
    else if (is_crossed_)
      out.contact = touches() ? Contact::along : Contact::crossing;
    else if (!landings_.empty())
      out.contact = Contact::at_point;
    else
      return out;
    for (const Index v : a_.points())
      if (b_.has(v))
        ends_.push_back(at(v));
    out.landings = std::move(landings_);
    measure(out);
    return out;
  }
  /// Whether one of them stays on one side of the other.
  [[nodiscard]] bool touches() const {
    if (!a_.is_triangle() || !b_.is_triangle())
      return false;
    return sides(a_, b_).is_weak || sides(b_, a_).is_weak;
  }
  [[nodiscard]] Meeting repeated() {
    Meeting out;
    out.contact = Contact::repeated;
    for (const Index v : a_.points())
      ends_.push_back(at(v));
    measure(out);
    return out;
  }
  void measure(Meeting &out) const {
    for (const Vector<3> &x : ends_) {
      out.where += x / static_cast<double>(ends_.size());
      for (const Vector<3> &y : ends_)
        out.extent = std::max(out.extent, (x - y).norm());
    }
  }
};

} // namespace

Meeting meeting_of(std::span<const Vector<3>> points, const Piece &a, const Piece &b) {
  return Encounter(points, a, b).meeting();
}

} // namespace anistar::generate
