#include "generate/constrained/recovery/gift_wrapping.h"

#include "generate/constrained/points/separation.h"
#include "generate/constrained/points/sphere_test.h"

#include <algorithm>
#include <unordered_map>

namespace anistar::generate {
namespace {

enum class Care { none, look_at_front };

/// The same facet, with its least vertex first.
Facet<3> turned(const Facet<3> &f) {
  if (f[1] < f[0] && f[1] < f[2])
    return {f[1], f[2], f[0]};
  if (f[2] < f[0] && f[2] < f[1])
    return {f[2], f[0], f[1]};
  return f;
}

Facet<3> reversed(const Facet<3> &f) { return turned({f[0], f[2], f[1]}); }

struct FacetHash {
  std::size_t operator()(const Facet<3> &f) const {
    std::uint64_t hash = 0;
    for (const Index v : f)
      hash = (hash ^ static_cast<std::uint32_t>(v)) * 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 32;
  }
};

struct Box {
  Vector<3> low, high;
};

template <class Vertices>
Box box_of(const ExactPoints &points, const Vertices &vertices) {
  Box box{points.rounded(vertices[0]), points.rounded(vertices[0])};
  for (const Index v : vertices) {
    box.low = box.low.cwiseMin(points.rounded(v));
    box.high = box.high.cwiseMax(points.rounded(v));
  }
  return box;
}

class Wrapper {
public:
  Wrapper(const ExactPoints &points, FacetSide &side, const HalfCavity &half, Care care)
      : points_(points), side_(side), half_(half), care_(care) {
    for (const Index v : half.vertices)
      error_ = std::max(error_, points.error(v));
  }

  std::optional<Wrapping> run(Monitor &monitor) {
    for (const Facet<3> &facet : half_.border)
      if (!push(turned(facet)))
        return std::nullopt;
    const std::size_t most =
        base_cells + cells_per_item * (half_.vertices.size() + half_.border.size());
    while (!place_.empty()) {
      monitor.insist(0);
      const Facet<3> facet = front_.back();
      if (!is_in_front(facet, front_.size() - 1)) {
        front_.pop_back();
        continue;
      }
      if (out_.cells.size() > most || !advance(facet))
        return std::nullopt;
    }
    return std::move(out_);
  }

private:
  /// A front that does not close is left: a polyhedron has fewer cells by far, save for
  /// stacks of convex polygons, whose cells are as many as the square of their
  /// vertices.
  static constexpr std::size_t base_cells = 200, cells_per_item = 60;

  const ExactPoints &points_;
  FacetSide &side_;
  const HalfCavity &half_;
  Care care_;
  double error_ = 0;
  Wrapping out_;
  std::vector<Facet<3>> front_; ///< with what has been covered meanwhile
  std::unordered_map<Facet<3>, std::size_t, FacetHash> place_; ///< in the front
  std::unordered_map<Facet<3>, std::size_t, FacetHash> ended_; ///< facets on the plane

  bool push(const Facet<3> &facet) {
    if (!place_.emplace(facet, front_.size()).second)
      return false;
    front_.push_back(facet);
    return true;
  }
  [[nodiscard]] bool is_in_front(const Facet<3> &facet) const {
    return place_.contains(facet);
  }
  [[nodiscard]] bool is_in_front(const Facet<3> &facet, std::size_t place) const {
    const auto at = place_.find(facet);
    return at != place_.end() && at->second == place;
  }
  [[nodiscard]] bool is_on_plane(const Facet<3> &facet) {
    return half_.is_open && side_.is_on(facet[0]) && side_.is_on(facet[1]) &&
           side_.is_on(facet[2]);
  }

  /// Covers a facet of the front with a cell. @returns false if there is none
  bool advance(const Facet<3> &facet) {
    std::vector<Index> rejected;
    for (;;) {
      const Index apex = best_apex(facet, rejected);
      if (apex == none)
        return false;
      const Cell<3> cell{facet[0], facet[1], facet[2], apex};
      if (fits(cell, rejected)) {
        glue(cell);
        return true;
      }
      ++out_.rejections;
      rejected.push_back(apex);
    }
  }

  [[nodiscard]] Index best_apex(const Facet<3> &facet,
                                const std::vector<Index> &rejected) const {
    const auto [a, b, c] = facet;
    const auto is_candidate = [&, a = a, b = b, c = c](Index v) {
      return v != a && v != b && v != c &&
             std::ranges::find(rejected, v) == rejected.end() &&
             points_.orientation(a, b, c, v) == Orientation::positive;
    };
    const auto &vertices = half_.vertices;
    const auto first = std::ranges::find_if(vertices, is_candidate);
    if (first == vertices.end())
      return none;
    Cell<3> best{a, b, c, *first};
    SphereTest sphere(points_, best, error_);
    for (auto v = first + 1; v != vertices.end(); ++v)
      if (*v != a && *v != b && *v != c && sphere.contains(*v) && is_candidate(*v)) {
        best[3] = *v;
        sphere = SphereTest(points_, best, error_);
      }
    return best[3];
  }

  [[nodiscard]] bool fits(const Cell<3> &cell, const std::vector<Index> &rejected) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Facet<3> made = turned(facet_of<3>(cell, i));
      if (is_in_front(made))
        continue;
      if (is_in_front(reversed(made)) ||
          (is_on_plane(made) && ended_.contains(reversed(made))))
        return false;
    }
    if (std::ranges::any_of(rejected, [&](Index v) { return contains(cell, v); }))
      return false;
    return care_ == Care::none || is_clear_of_front(cell);
  }

  [[nodiscard]] bool contains(const Cell<3> &cell, Index v) const {
    for (std::size_t i = 0; i < 4; ++i) {
      const auto [a, b, c] = facet_of<3>(cell, i);
      if (points_.orientation(a, b, c, v) == Orientation::negative)
        return false;
    }
    return true;
  }

  [[nodiscard]] bool is_clear_of_front(const Cell<3> &cell) const {
    const Box box = box_of(points_, cell);
    for (std::size_t k = 0; k < front_.size(); ++k) {
      const Facet<3> &facet = front_[k];
      if (!is_in_front(facet, k))
        continue;
      const Box other = box_of(points_, facet);
      const double slack = 2 * error_;
      if (((other.low - box.high).array() > slack).any() ||
          ((box.low - other.high).array() > slack).any())
        continue;
      if (turned(facet_of<3>(cell, 3)) != facet && !are_separated(points_, cell, facet))
        return false;
    }
    return true;
  }

  void glue(const Cell<3> &cell) {
    out_.cells.push_back(cell);
    place_.erase(facet_of<3>(cell, 3));
    for (std::size_t i = 0; i < 3; ++i) {
      const Facet<3> made = turned(facet_of<3>(cell, i));
      if (place_.erase(made) > 0)
        continue;
      if (is_on_plane(made)) {
        ended_.emplace(made, out_.on_plane.size());
        out_.on_plane.push_back(made);
      } else {
        push(reversed(made));
      }
    }
  }
};

} // namespace

std::optional<Wrapping> wrapped(const ExactPoints &points, FacetSide &side,
                                const HalfCavity &half, Monitor &monitor) {
  if (auto fast = Wrapper(points, side, half, Care::none).run(monitor))
    return fast;
  return Wrapper(points, side, half, Care::look_at_front).run(monitor);
}

} // namespace anistar::generate
