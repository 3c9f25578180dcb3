#include "tet_shape.h"

namespace anistar {

bool is_in_ball(const SymmetricTensor<3> &M, const Vector<3> &a, const Vector<3> &b,
                const Vector<3> &c, const Vector<3> &d, const Vector<3> &p) {
  const Vector<3> u = a - p, v = b - p, w = c - p, x = d - p;
  const Vector<3> vw = v.cross(w), ux = u.cross(x);
  const double terms[4] = {
      x.dot(vw) * quadratic<3>(M, u), w.dot(ux) * quadratic<3>(M, v),
      -v.dot(ux) * quadratic<3>(M, w), -u.dot(vw) * quadratic<3>(M, x)};
  double det = 0, size = 0;
  for (const double term : terms) {
    det += term;
    size += std::abs(term);
  }
  return det > 1e-9 * size;
}

void StarShapes::evaluate(const Vertex<3> &vertex) {
  const double x = vertex.x[0], y = vertex.x[1], z = vertex.x[2];
  const auto &M = vertex.M.entries;
  for (std::size_t i = 0; i < n_; ++i) {
    const double m[6] = {m_[0][i] + M[0], m_[1][i] + M[1], m_[2][i] + M[2],
                         m_[3][i] + M[3], m_[4][i] + M[4], m_[5][i] + M[5]};
    cubed_[i] = cubed_shape(a_[0][i] - x, a_[1][i] - y, a_[2][i] - z, b_[0][i] - x,
                            b_[1][i] - y, b_[2][i] - z, c_[0][i] - x, c_[1][i] - y,
                            c_[2][i] - z, m);
  }
  for (std::size_t i = 0; i < n_; ++i)
    quality_[i] = mean_ratio(cubed_[i]);
  float least = 1;
  double sum = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    least = std::min(least, quality_[i]);
    sum += static_cast<double>(quality_[i]);
  }
  minimum_ = static_cast<double>(least);
  sum_ = sum;
}

} // namespace anistar
