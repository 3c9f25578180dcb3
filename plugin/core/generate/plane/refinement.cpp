#include "generate/plane/refinement.h"

#include "generate/plane/triangle_shape.h"
#include "generate/plane/walk.h"

#include <queue>

namespace anistar::generate {
namespace {

/// Circumradius of a triangle over the wanted length of its edges, and length of a part
/// of a segment over it, above which they are divided: then edges have that length in
/// the mean.
constexpr double largest_radius = .75;
constexpr double largest_length = 1.4;

/// What is nearer to each other, relative to the largest coordinate, has hardly a
/// double in between.
constexpr double closest = 0x1p-44;

/// At smaller angles the sides do not encroach each other, and what spans them is left.
constexpr double tiny_angle = square_of_cos_15;

/// Distances from the apex of a small angle are equal up to this factor.
constexpr double equal_distance = 1.001;

/// How far to divide an edge of some length from a small angle at its start: a power of
/// two between a third and two thirds, so that all segments there are divided alike.
double distance_on_shell(double length) {
  int exponent = 0;
  (void)std::frexp(length, &exponent);
  const double below = std::ldexp(.5, exponent); // at most the length
  return length < 1.5 * below ? .5 * below : below;
}

/// Which vertices lie on which segments.
class OnSegments {
public:
  OnSegments(const PlaneMesh &mesh, const InputAngles &angles)
      : mesh_(mesh), angles_(angles), segment_(mesh.points.size(), none) {
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      for (std::size_t i = 0; i < 3; ++i)
        if (mesh.walls[c][i] != none)
          for (const Index v : facet_of<2>(mesh.cells[c], i))
            segment_[v] = mesh.walls[c][i];
  }
  /// Takes note of a new vertex.
  void add(Index segment) { segment_.push_back(segment); }

  [[nodiscard]] std::span<const Index> at(Index v) const {
    if (is_given(v))
      return angles_.segments_at(v);
    return std::span(&segment_[v], segment_[v] == none ? 0 : 1);
  }
  [[nodiscard]] bool is_apex(Index v) const {
    return is_given(v) && angles_.is_apex(v);
  }
  /// Whether v lies on another segment that meets s at a tiny angle.
  [[nodiscard]] bool are_in_tiny_angle(Index s, Index v) const {
    for (const Index t : at(v))
      if (const Index apex = apex_of(s, t);
          apex != none && apex != v &&
          is_smaller(arm(s, apex), arm(t, apex), tiny_angle))
        return true;
    return false;
  }
  /// Whether the edge between u and v spans a small angle of the input, as an edge of a
  /// shell does: refinement would only repeat it nearer to the apex.
  [[nodiscard]] bool span_small_angle(Index u, Index v) const {
    for (const Index s : at(u))
      for (const Index t : at(v)) {
        const Index apex = apex_of(s, t);
        if (apex == none || apex == u || apex == v)
          continue;
        const Vector<2> one = arm(s, apex), other = arm(t, apex);
        if (is_smaller(one, other, tiny_angle) ||
            (is_smaller(one, other, square_of_cos_60) && are_on_one_shell(u, v, apex)))
          return true;
      }
    return false;
  }

private:
  const PlaneMesh &mesh_;
  const InputAngles &angles_;
  PerVertex<Index> segment_;

  [[nodiscard]] bool is_given(Index v) const {
    return static_cast<std::size_t>(v) < angles_.points().size();
  }
  /// The point that two segments share.
  [[nodiscard]] Index apex_of(Index s, Index t) const {
    const auto [a, b] = angles_.segments()[s];
    const auto [c, d] = angles_.segments()[t];
    return s == t ? none : a == c || a == d ? a : b == c || b == d ? b : none;
  }
  [[nodiscard]] Vector<2> arm(Index s, Index apex) const {
    const auto [a, b] = angles_.segments()[s];
    return angles_.points()[a == apex ? b : a] - angles_.points()[apex];
  }
  [[nodiscard]] bool are_on_one_shell(Index u, Index v, Index apex) const {
    const double one = (mesh_.points[u] - mesh_.points[apex]).squaredNorm(),
                 other = (mesh_.points[v] - mesh_.points[apex]).squaredNorm();
    constexpr double factor = equal_distance * equal_distance;
    return one <= factor * other && other <= factor * one;
  }
};

/// A part of a segment, as long as the triangle at it stays.
struct Part {
  HalfFacet at;
  Facet<2> ends;
};

/// A triangle that is to go, as long as it stays.
struct BadCell {
  Index cell;
  Cell<2> vertices;
};

class Refinement {
public:
  Refinement(PlaneMesh &mesh, const InputAngles &angles, PlaneCriteria criteria,
             Monitor &monitor)
      : mesh_(mesh), criteria_(std::move(criteria)), monitor_(monitor),
        on_segments_(mesh, angles) {
    double largest = 0;
    for (const Vector<2> &x : mesh.points)
      largest = std::max(largest, x.cwiseAbs().maxCoeff());
    closest_ = closest * largest;
  }

  PlaneRefinementCounts run() {
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
      look_at(static_cast<Index>(c));
    while (monitor_.keep_going(mesh_.points.size(), fraction())) {
      if (!encroached_.empty())
        (void)split(take(encroached_));
      else if (!bad_.empty())
        improve(take(bad_));
      else
        break;
    }
    return counts_;
  }

private:
  PlaneMesh &mesh_;
  PlaneCriteria criteria_;
  Monitor &monitor_;
  OnSegments on_segments_;
  double closest_;
  std::queue<Part> encroached_;
  std::queue<BadCell> bad_;
  PerCell<std::uint32_t> seen_; ///< the last search that came there
  std::uint32_t search_ = 0;
  PlaneRefinementCounts counts_;

  template <class T> static T take(std::queue<T> &queue) {
    const T first = queue.front();
    queue.pop();
    return first;
  }
  [[nodiscard]] double fraction() const {
    const double done = static_cast<double>(mesh_.points.size());
    return done / (done + static_cast<double>(bad_.size()));
  }

  /// Notes what is wrong with a triangle and with the segments at it.
  void look_at(Index c) {
    for (std::size_t i = 0; i < 3; ++i)
      if (const HalfFacet h(c, i);
          mesh_.wall(h) != none && (is_encroached(h) || is_long(h)))
        encroached_.push({h, mesh_.edge(h)});
    if (is_bad(c))
      bad_.push({c, mesh_.cells[c]});
  }
  [[nodiscard]] bool encroaches(const Vector<2> &p, HalfFacet h) const {
    const auto [a, b] = mesh_.edge(h);
    return (mesh_.points[a] - p).dot(mesh_.points[b] - p) < 0;
  }
  [[nodiscard]] bool is_encroached(HalfFacet h) const {
    const Index apex = mesh_.apex(h);
    return encroaches(mesh_.points[apex], h) &&
           !on_segments_.are_in_tiny_angle(mesh_.wall(h), apex);
  }
  [[nodiscard]] bool is_long(HalfFacet h) const {
    const auto [a, b] = mesh_.edge(h);
    const double size =
        std::min(.5 * (criteria_.sizes[a] + criteria_.sizes[b]), size_in(h.cell()));
    const double bound = largest_length * size;
    return (mesh_.points[a] - mesh_.points[b]).squaredNorm() > bound * bound;
  }
  /// Of its region.
  [[nodiscard]] double size_in(Index c) const {
    const auto &tags = criteria_.region_tags;
    const auto found = std::lower_bound(tags.begin(), tags.end(), mesh_.regions[c]);
    return found != tags.end() && *found == mesh_.regions[c]
               ? criteria_.region_sizes[found - tags.begin()]
               : std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] double size_of(Index c) const {
    const auto [i, j, k] = mesh_.cells[c];
    const auto &sizes = criteria_.sizes;
    return std::min((sizes[i] + sizes[j] + sizes[k]) / 3, size_in(c));
  }
  [[nodiscard]] bool is_skinny(const TriangleShape &shape) const {
    return shape.ratio_square() > criteria_.bound * criteria_.bound;
  }
  [[nodiscard]] bool is_large(Index c, const TriangleShape &shape) const {
    const double bound = largest_radius * size_of(c);
    return shape.radius_square() > bound * bound;
  }
  [[nodiscard]] bool is_at_small_angle(Index c, const TriangleShape &shape) const {
    const auto [u, v] = facet_of<2>(mesh_.cells[c], shape.shortest());
    return on_segments_.span_small_angle(u, v);
  }
  [[nodiscard]] bool is_bad(Index c) {
    const Simplex<2> s = mesh_.simplex(c);
    const TriangleShape shape(s);
    if (!is_skinny(shape))
      return is_large(c, shape);
    if (!is_at_small_angle(c, shape))
      return true;
    // its circumradius may be large without an edge that is
    const double bound = largest_length * size_of(c);
    return shape.longest_square() > bound * bound;
  }

  /// Inserts a point on a part of a segment.
  /// @returns whether it was there and has room for one
  bool split(const Part &part) {
    const HalfFacet h = part.at;
    if (mesh_.edge(h) != part.ends || mesh_.wall(h) == none)
      return false;
    auto [a, b] = part.ends;
    if (on_segments_.is_apex(b))
      std::swap(a, b);
    const Vector<2> way = mesh_.points[b] - mesh_.points[a];
    const double length = way.norm();
    const bool is_on_shells = on_segments_.is_apex(a) && !on_segments_.is_apex(b);
    const double share = is_on_shells ? distance_on_shell(length) / length : .5;
    const Vector<2> x = mesh_.points[a] + share * way;
    if (length <= closest_ || !has_room_on_edge(mesh_, h, x)) {
      ++counts_.refused;
      return false;
    }
    const double size = (1 - share) * criteria_.sizes[a] + share * criteria_.sizes[b];
    const Index v = add(x, size, mesh_.wall(h));
    look_around(v, insert_on_edge(mesh_, h));
    ++counts_.split_segments;
    return true;
  }
  [[nodiscard]] Index add(const Vector<2> &x, double size, Index segment) {
    mesh_.points.push_back(x);
    criteria_.sizes.push_back(size);
    on_segments_.add(segment);
    return static_cast<Index>(mesh_.points.size()) - 1;
  }
  void look_around(Index v, Index cell) {
    for_star(mesh_, v, cell, [this](HalfFacet h) { look_at(h.cell()); });
  }

  /// Inserts the centre of a triangle, or splits what it encroaches.
  void improve(const BadCell &bad) {
    if (mesh_.cells[bad.cell] != bad.vertices)
      return;
    const Simplex<2> s = mesh_.simplex(bad.cell);
    const TriangleShape shape(s);
    const Vector<2> x =
        is_skinny(shape) ? shape.off_centre(criteria_.bound) : shape.circumcentre();
    if (!std::isfinite(x[0]) || !std::isfinite(x[1])) {
      ++counts_.refused;
      return;
    }
    const Place place = walk_to(mesh_, bad.cell, x, Walls::stop);
    const std::vector<Part> parts = encroached_at(place, x);
    if (parts.empty()) {
      insert(place, x);
      return;
    }
    ++counts_.rejected;
    bool has_split = false;
    for (const Part &part : parts)
      has_split = split(part) || has_split;
    if (!has_split)
      ++counts_.refused;
    else if (mesh_.cells[bad.cell] == bad.vertices)
      bad_.push(bad);
  }
  /// The parts of segments that a point in a place would encroach.
  [[nodiscard]] std::vector<Part> encroached_at(const Place &place,
                                                const Vector<2> &x) {
    if (place.kind == Place::Kind::on_vertex)
      return {};
    if (place.kind == Place::Kind::beyond ||
        (place.kind == Place::Kind::on_edge && mesh_.wall(place.at) != none))
      return {{place.at, mesh_.edge(place.at)}};
    std::vector<Part> found;
    seen_.resize(mesh_.cells.size(), 0);
    ++search_;
    std::vector<Index> front{place.at.cell()};
    seen_[front.front()] = search_;
    while (!front.empty()) {
      const Index c = front.back();
      front.pop_back();
      for (std::size_t i = 0; i < 3; ++i) {
        const HalfFacet h(c, i), other = mesh_.opposite(h);
        if (mesh_.wall(h) != none) {
          if (encroaches(x, h))
            found.push_back({h, mesh_.edge(h)});
        } else if (seen_[other.cell()] != search_ &&
                   is_in_circle(mesh_, other.cell(), x)) {
          seen_[other.cell()] = search_;
          front.push_back(other.cell());
        }
      }
    }
    return found;
  }
  void insert(const Place &place, const Vector<2> &x) {
    const Cell<2> cell = mesh_.cells[place.at.cell()];
    bool has_room = place.kind != Place::Kind::on_vertex;
    for (const Index v : cell)
      has_room = has_room && (mesh_.points[v] - x).norm() > closest_;
    const bool is_on_edge = place.kind == Place::Kind::on_edge;
    if (!has_room || (is_on_edge && !has_room_on_edge(mesh_, place.at, x))) {
      ++counts_.refused;
      return;
    }
    const Index v = add(x, size_at(cell, x), none);
    look_around(v, is_on_edge ? insert_on_edge(mesh_, place.at)
                              : insert_in_cell(mesh_, place.at.cell()));
    ++counts_.off_centres;
  }
  /// The size at a place in a triangle, interpolated.
  [[nodiscard]] double size_at(const Cell<2> &cell, const Vector<2> &x) const {
    double sum = 0, weights = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = facet_of<2>(cell, i);
      const double weight = std::abs(cross(mesh_.points[a] - x, mesh_.points[b] - x));
      sum += weight * criteria_.sizes[cell[i]];
      weights += weight;
    }
    return sum / weights;
  }

public:
  /// Triangles that are worse than the bound.
  [[nodiscard]] std::size_t skinny_at_small_angles() const {
    std::size_t count = 0;
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
      const Simplex<2> s = mesh_.simplex(static_cast<Index>(c));
      const TriangleShape shape(s);
      count += is_skinny(shape) && is_at_small_angle(static_cast<Index>(c), shape);
    }
    return count;
  }
};

} // namespace

PlaneRefinementCounts refine(PlaneMesh &mesh, const InputAngles &angles,
                             PlaneCriteria criteria, Monitor &monitor) {
  Refinement refinement(mesh, angles, std::move(criteria), monitor);
  PlaneRefinementCounts counts = refinement.run();
  counts.at_small_angles = refinement.skinny_at_small_angles();
  return counts;
}

} // namespace anistar::generate
