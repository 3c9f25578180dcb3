#include "generate/refinement/rules/clusters.h"

#include <algorithm>
#include <cmath>

namespace anistar::generate {
namespace {

constexpr double cos_cluster = .5; // of 60 degrees

/// A power of two between length / (2 sqrt 2) and length / sqrt 2: both pieces of a
/// subsegment that starts at the centre are at least .29 of it.
double sphere_radius(double length) {
  int exponent;
  (void)std::frexp(length / std::sqrt(2.), &exponent); // 2^(exponent - 1) <= it
  return std::ldexp(1., exponent - 1);
}

struct Ray {
  Index vertex, segment;
  Vector<3> direction;
};

/// The segments as they leave their ends, vertex by vertex.
std::vector<Ray> rays_of(const WalledMesh &mesh) {
  std::vector<Ray> rays;
  for (const auto &[edge, segment] : mesh.initial_edges)
    for (std::size_t k = 0; k < 2; ++k)
      if (mesh.carriers[edge[k]].kind == Carrier::Kind::vertex)
        rays.push_back(
            {edge[k], segment,
             (mesh.points[edge[1 - k]] - mesh.points[edge[k]]).normalized()});
  std::stable_sort(rays.begin(), rays.end(),
                   [](const Ray &a, const Ray &b) { return a.vertex < b.vertex; });
  return rays;
}

} // namespace

Clusters::Clusters(const WalledMesh &mesh) : ends_(mesh.n_segments) {
  const std::vector<Ray> rays = rays_of(mesh);
  for (std::size_t first = 0, last; first < rays.size(); first = last) {
    for (last = first; last < rays.size() && rays[last].vertex == rays[first].vertex;)
      ++last;
    double gap = no_cluster;
    std::vector<std::size_t> members;
    for (std::size_t i = first; i < last; ++i) {
      bool is_member = false;
      for (std::size_t j = first; j < last; ++j)
        if (i != j && rays[i].direction.dot(rays[j].direction) > cos_cluster) {
          is_member = true;
          gap = std::min(gap, (rays[i].direction - rays[j].direction).norm());
        }
      if (is_member)
        members.push_back(i);
    }
    n_clusters_ += !members.empty();
    for (std::size_t i : members) {
      auto &ends = ends_[rays[i].segment];
      ends[ends[0].vertex == none ? 0 : 1] = {rays[i].vertex, gap};
    }
  }
}

const Clusters::End *Clusters::clustered_end(Index segment, Index v) const {
  for (const End &end : ends_[segment])
    if (end.vertex == v)
      return &end;
  return nullptr;
}

double Clusters::split_fraction(const WalledMesh &mesh, Index segment, Index a,
                                Index b) const {
  const bool at_a = clustered_end(segment, a), at_b = clustered_end(segment, b);
  if (at_a == at_b)
    return .5;
  const double length = (mesh.points[b] - mesh.points[a]).norm();
  const double fraction = sphere_radius(length) / length;
  return at_a ? fraction : 1 - fraction;
}

double Clusters::least_insertion_radius(const WalledMesh &mesh, Index segment, Index a,
                                        Index b) const {
  const double length = (mesh.points[b] - mesh.points[a]).norm();
  const double t = split_fraction(mesh, segment, a, b);
  double least = length * std::min(t, 1 - t);
  const End *at_a = clustered_end(segment, a), *at_b = clustered_end(segment, b);
  if (at_a && !at_b)
    least = std::min(least, length * t * at_a->gap);
  if (at_b && !at_a)
    least = std::min(least, length * (1 - t) * at_b->gap);
  return least;
}

} // namespace anistar::generate
