#include "plane/mesh/displacements.h"

namespace anistar {
namespace {

/// Step of the pliant forces, the damping of the published algorithm.
constexpr double pliant_step = .2;
/// Over-relaxation is unstable where the metric varies: stop short of the
/// circumcentres.
constexpr double odt_step = .8;

/// Centre of the circumscribed ellipse of v, a, b in their mean metric, from v,
/// weighted by the area in that metric.
struct Weighted {
  Vector<2> sum = Vector<2>::Zero();
  double weight = 0;
};

void add_circumcentre(const Vertex<2> &v, const Vertex<2> &a, const Vertex<2> &b,
                      Weighted &mean) {
  const SymmetricTensor<2> M = v.weight * v.M + a.weight * a.M + b.weight * b.M;
  const double area = cross(a.x - v.x, b.x - v.x);
  const double weight = area / elementary::cube_root(v.weight * a.weight * b.weight);
  mean.sum += weight * circumcircle(M, v.x, a.x, b.x).offset;
  mean.weight += weight;
}

} // namespace

Vector<2> pliant_displacement(const Triangulation<2> &mesh, const Vertex<2> &v,
                              std::span<const HalfFacet> star) {
  Vector<2> force = Vector<2>::Zero();
  const auto pull = [&](const Vertex<2> &neighbour) {
    const double length = edge_length(v, neighbour);
    const double fourth = length * length * length * length;
    force -= ((1 - fourth) * elementary::exp(-fourth) / length) * (neighbour.x - v.x);
  };
  for (HalfFacet h : star)
    pull(mesh.vertex(mesh.facet(h)[0]));
  return pliant_step * force;
}

Vector<2> odt_displacement(const Triangulation<2> &mesh, const Vertex<2> &v,
                           std::span<const HalfFacet> star) {
  Weighted mean;
  for (HalfFacet h : star) {
    const auto [a, b] = mesh.facet(h);
    add_circumcentre(v, mesh.vertex(a), mesh.vertex(b), mean);
  }
  return (odt_step / mean.weight) * mean.sum;
}

} // namespace anistar
