#include "generate/facets/planar_facets.h"

#include "generate/facets/triangle_sides.h"

#include <numeric>
#include <tuple>

namespace anistar::generate {
namespace {

/// What is found once more each time comes to an end after two or three.
constexpr int max_refits = 8;

class Growth {
public:
  Growth(std::span<const Vector<3>> points, std::span<const Facet<3>> triangles,
         std::span<const Index> tags, const Planarity &planarity)
      : points_(points), triangles_(triangles), tags_(tags), planarity_(planarity),
        across_(triangle_sides(triangles, points.size())),
        facet_of_(triangles.size(), none), normals_(triangles.size()) {
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      const auto &[a, b, c] = triangles[k];
      normals_[k] = (points[b] - points[a]).cross(points[c] - points[a]);
    }
  }

  std::vector<Index> run() {
    Index n_facets = 0;
    for (const Index seed : largest_first())
      if (facet_of_[seed] == none)
        grow(seed, n_facets++);
    return numbered(static_cast<std::size_t>(n_facets));
  }

private:
  /// A triangle of the facet, and whether its normal is against that of the seed.
  struct Member {
    Index triangle;
    bool is_turned;
  };
  struct Plane {
    Vector<3> normal, origin; ///< the normal of length 1
  };
  std::span<const Vector<3>> points_;
  std::span<const Facet<3>> triangles_;
  std::span<const Index> tags_;
  Planarity planarity_;
  std::vector<SidesOfTriangle> across_;
  std::vector<Index> facet_of_;
  std::vector<Vector<3>> normals_; ///< twice the area long

  [[nodiscard]] std::vector<Index> largest_first() const {
    std::vector<double> square(normals_.size());
    std::transform(normals_.begin(), normals_.end(), square.begin(),
                   [](const Vector<3> &n) { return n.squaredNorm(); });
    std::vector<Index> order(normals_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return square[a] > square[b]; });
    return order;
  }

  /// From the plane of the seed, and then from that of what has been found, as long as
  /// more is found: a small seed tells its plane badly where coordinates are rounded.
  void grow(Index seed, Index facet) {
    facet_of_[seed] = facet;
    const double length = normals_[seed].norm();
    if (!(length > 0))
      return;
    Plane plane{normals_[seed] / length, points_[triangles_[seed][0]]};
    std::vector<Member> found = around(seed, facet, plane);
    for (int round = 0; round < max_refits && found.size() > 2; ++round) {
      plane = plane_of(found);
      if (!is_planar({seed, false}, plane))
        return;
      release(found);
      std::vector<Member> next = around(seed, facet, plane);
      if (next.size() <= found.size()) {
        release(next);
        for (const Member &member : found)
          facet_of_[member.triangle] = facet;
        return;
      }
      found = std::move(next);
    }
  }

  [[nodiscard]] std::vector<Member> around(Index seed, Index facet,
                                           const Plane &plane) {
    facet_of_[seed] = facet;
    std::vector<Member> members{{seed, false}};
    for (std::size_t k = 0; k < members.size(); ++k) {
      const Member from = members[k];
      for (const AcrossSide &to : across_[from.triangle]) {
        if (to.triangle == none || facet_of_[to.triangle] != none ||
            tags_[to.triangle] != tags_[seed])
          continue;
        const Member member{to.triangle, from.is_turned != to.is_turned};
        if (!is_planar(member, plane))
          continue;
        facet_of_[member.triangle] = facet;
        members.push_back(member);
      }
    }
    return members;
  }

  void release(std::span<const Member> members) {
    for (const Member &member : members)
      facet_of_[member.triangle] = none;
  }

  /// Through the middle of triangles, with the mean of their normals.
  [[nodiscard]] Plane plane_of(std::span<const Member> members) const {
    const Vector<3> &first = points_[triangles_[members[0].triangle][0]];
    Vector<3> normal = Vector<3>::Zero(), moment = Vector<3>::Zero();
    double area = 0;
    for (const Member &member : members) {
      const Vector<3> &own = normals_[member.triangle];
      const double weight = own.norm();
      normal += member.is_turned ? Vector<3>(-own) : own;
      for (const Index v : triangles_[member.triangle])
        moment += weight / 3 * (points_[v] - first);
      area += weight;
    }
    return {normal / normal.norm(), first + moment / area};
  }

  [[nodiscard]] bool is_planar(const Member &member, const Plane &plane) const {
    const auto &[normal, origin] = plane;
    double lowest = 0, highest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double height =
          normal.dot(points_[triangles_[member.triangle][i]] - origin);
      if (std::abs(height) > planarity_.distance)
        return false;
      lowest = i == 0 ? height : std::min(lowest, height);
      highest = i == 0 ? height : std::max(highest, height);
    }
    const Vector<3> &own = normals_[member.triangle];
    const double along = own.dot(normal);
    if (!(member.is_turned ? along < 0 : along > 0))
      return false;
    return highest - lowest <= planarity_.rounding ||
           own.cross(normal).squaredNorm() <=
               planarity_.sine * planarity_.sine * own.squaredNorm();
  }

  /// In the order of the triangles.
  [[nodiscard]] std::vector<Index> numbered(std::size_t n_facets) {
    std::vector<Index> number(n_facets, none);
    Index n = 0;
    for (Index &facet : facet_of_) {
      if (number[facet] == none)
        number[facet] = n++;
      facet = number[facet];
    }
    return std::move(facet_of_);
  }
};

} // namespace

std::vector<Index> planar_facets(std::span<const Vector<3>> points,
                                 std::span<const Facet<3>> triangles,
                                 std::span<const Index> tags,
                                 const Planarity &planarity) {
  return Growth(points, triangles, tags, planarity).run();
}

} // namespace anistar::generate
