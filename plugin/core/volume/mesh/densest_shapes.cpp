#include "volume/mesh/densest_shapes.h"

namespace anistar {

void DensestShapes::add(const Vertex<3> &a, const Vertex<3> &b, const Vertex<3> &c) {
  for (int k = 0; k < 3; ++k) {
    a_[k][n_] = a.x[k];
    b_[k][n_] = c.x[k]; // seen from the vertex the order turns
    c_[k][n_] = b.x[k];
  }
  const Vertex<3> *densest = a.weight <= b.weight ? &a : &b;
  if (c.weight < densest->weight)
    densest = &c;
  weight_[n_] = densest->weight;
  for (std::size_t k = 0; k < 6; ++k)
    m_[k][n_] = densest->M.entries[k];
  ++n_;
}

void DensestShapes::evaluate(const Vertex<3> &vertex, double poor) {
  const double x = vertex.x[0], y = vertex.x[1], z = vertex.x[2];
  const double weight = vertex.weight;
  const std::array<double, 6> M = vertex.M.entries;
  const auto densest = [&](std::size_t k, std::size_t i) {
    const double there = m_[k][i];
    return weight < weight_[i] ? M[k] : there;
  };
  for (std::size_t i = 0; i < n_; ++i) {
    const double m[6] = {densest(0, i), densest(1, i), densest(2, i),
                         densest(3, i), densest(4, i), densest(5, i)};
    cubed_[i] = cubed_shape(a_[0][i] - x, a_[1][i] - y, a_[2][i] - z, b_[0][i] - x,
                            b_[1][i] - y, b_[2][i] - z, c_[0][i] - x, c_[1][i] - y,
                            c_[2][i] - z, m);
  }
  for (std::size_t i = 0; i < n_; ++i)
    quality_[i] = mean_ratio(cubed_[i]);
  const auto bound = static_cast<float>(poor);
  float least = 1, sum = 0, missing = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    const float q = quality_[i];
    least = std::min(least, q);
    sum += q;
    missing += std::max(0.f, bound - q);
  }
  minimum_ = static_cast<double>(least);
  sum_ = static_cast<double>(sum);
  missing_ = static_cast<double>(missing);
}

} // namespace anistar
